// Where the engine takes its flights from and where it puts them: a lane that ends is filled with the next
// one.
#pragma once

#include "core/flight/flight_record.h"

namespace dispersa {

class FlightQueue {
 public:
  virtual ~FlightQueue() = default;

  /// The next flight, or null when there is none now. `idle`: no lane flies, so that it may wait; null then
  /// ends the batch. The record stays the queue's.
  virtual FlightRecord* Next(bool idle) = 0;
  /// The flight has ended.
  virtual void Done(FlightRecord* record) = 0;
};

}  // namespace dispersa
