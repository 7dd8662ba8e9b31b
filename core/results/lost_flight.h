// A flight that was not completed.
#pragma once

#include <cstdint>
#include <string>

#include "core/flight/metrics.h"

namespace dispersa {

struct LostFlight {
  std::uint64_t case_index = 0;
  Outcome outcome = Outcome::kLostControl;
  double end_time_s = 0.0;
  int end_stage = 0;
  std::string reason;
};

}  // namespace dispersa
