// The ticks of a flight, for tests that look into it.
#pragma once

#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "tests/test.h"

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

/// The samples between two times. The flight must reach the second, and goes no farther.
inline std::vector<TickSample> TicksBetween(const FlightModel& model, const FlightInputs& inputs,
                                            double from_s, double to_s,
                                            Scheme scheme = FlightOptions{}.scheme) {
  struct Reached {};
  std::vector<TickSample> ticks;
  FlightOptions options;
  options.scheme = scheme;
  options.observe = [&](const TickSample& sample) {
    if (sample.time_s >= to_s) throw Reached();
    if (sample.time_s > from_s) ticks.push_back(sample);
  };
  try {
    ADD_FAILURE() << "ended before " << to_s << " s: " << Fly(model, inputs, options).reason;
  } catch (const Reached&) {
  }
  return ticks;
}

}  // namespace dispersa
