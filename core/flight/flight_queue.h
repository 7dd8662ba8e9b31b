// The engine takes its flights from this queue and returns them to it. A lane whose flight ends takes the
// next one.
#pragma once

#include "core/flight/flight_record.h"

namespace dispersa {

class FlightQueue {
 public:
  virtual ~FlightQueue() = default;

  /// The next flight, or null if there is none now. `idle` says that no lane flies: the queue may then wait,
  /// and null ends the batch. The queue keeps ownership of the record.
  virtual FlightRecord* Next(bool idle) = 0;
  /// The flight has ended.
  virtual void Done(FlightRecord* record) = 0;
};

}  // namespace dispersa
