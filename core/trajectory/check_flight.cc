#include "core/trajectory/check_flight.h"

#include <fmt/format.h>

namespace dispersa {

std::string CheckFlightText(const CheckFlight& flight) {
  if (flight.completed()) return fmt::format("check flight: completed at {:.6g} s", flight.end_time_s);
  return fmt::format("check flight: lost at {:.6g} s, because {}", flight.end_time_s,
                     flight.reason.empty() ? OutcomeName(flight.outcome) : flight.reason);
}

}  // namespace dispersa
