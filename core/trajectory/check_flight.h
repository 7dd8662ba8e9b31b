// The flight that shows whether a reference can be flown: with six degrees of freedom, under an autopilot.
#pragma once

#include <string>

#include "core/flight/outcome.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

struct CheckFlight {
  Outcome outcome = Outcome::kCompleted;
  double end_time_s = 0.0;  ///< since lift-off
  std::string reason;       ///< one sentence (empty when completed)
  OrbitErrors errors = {};  ///< at the injection of a completed flight

  bool completed() const { return outcome == Outcome::kCompleted; }
};

/// "check flight: lost at 26 s, because ..."
std::string CheckFlightText(const CheckFlight& flight);

}  // namespace dispersa
