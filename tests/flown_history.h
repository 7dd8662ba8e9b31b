// A flight with its history, by any integrator, and how far two of them are apart.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/flight/flight.h"
#include "core/flight/history.h"
#include "core/flight/tick_sample.h"
#include "tests/test.h"

namespace dispersa {

struct Flown {
  FlightResult result;
  History history;
};

/// Of a flight whose history is sampled each 0.1 s.
inline FlightOptions SampledOptions(Scheme scheme, int steps_per_tick, History& history) {
  history.step_s = 0.1;
  FlightOptions options;
  options.scheme = scheme;
  options.steps_per_tick = steps_per_tick;
  options.history = &history;
  return options;
}

inline Flown FlyWith(const FlightModel& model, const FlightInputs& inputs, Scheme scheme,
                     int steps_per_tick) {
  Flown flown;
  flown.result = Fly(model, inputs, SampledOptions(scheme, steps_per_tick, flown.history));
  return flown;
}

/// Up to a time, which the flight must reach, and no farther: without a result.
inline Flown FlyUntil(const FlightModel& model, const FlightInputs& inputs, Scheme scheme, double until_s,
                      int steps_per_tick = 1) {
  struct Reached {};
  Flown flown;
  FlightOptions options = SampledOptions(scheme, steps_per_tick, flown.history);
  options.observe = [&](const TickSample& sample) {
    if (sample.time_s > until_s) throw Reached();
  };
  try {
    ADD_FAILURE() << "ended before " << until_s << " s: " << Fly(model, inputs, options).reason;
  } catch (const Reached&) {
  }
  return flown;
}

/// Largest difference of a column between two flights, as long as the first one's time is below `until_s`.
inline double Apart(const Flown& a, const Flown& b, const char* column, double until_s) {
  const int at = FindHistoryColumn(column), time = FindHistoryColumn("time_s");
  double largest = 0.0;
  for (std::size_t row = 0; row < std::min(a.history.rows(), b.history.rows()); ++row)
    if (a.history.at(row, time) < until_s)
      largest = std::max(largest, std::fabs(a.history.at(row, at) - b.history.at(row, at)));
  return largest;
}

}  // namespace dispersa
