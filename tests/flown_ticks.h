// The ticks of a flight, for tests that look into it.
#pragma once

#include <vector>

#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"

namespace dispersa {

/// Every sample that an observer of the flight gets. `result`: null if it is not wanted.
inline std::vector<TickSample> TicksOf(const FlightDefinition& definition, const FlightInputs& inputs,
                                       FlightResult* result = nullptr, FlightOptions options = {}) {
  std::vector<TickSample> ticks;
  options.observe = [&](const TickSample& sample) { ticks.push_back(sample); };
  const FlightResult flown = Fly(FlightModel(definition), inputs, options);
  if (result) *result = flown;
  return ticks;
}

}  // namespace dispersa
