// Work and precision of the integration of a whole closed-loop flight, as CSV on stdout:
//   work_precision CAMPAIGNS_FOLDER > work_precision.csv
// For each autopilot tick the shipped scheme with 1, 2, 4 and 8 steps a tick against CVODE (relative
// tolerance 1e-12) on the same tick, so that only the integration differs, never the controller.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/slv4_flight.h"

namespace {

using namespace dispersa;

struct Flown {
  FlightResult result;
  History history;
  double cpu_s = 0.0;
};

Flown FlyOnce(const FlightModel& model, const FlightInputs& inputs, Scheme scheme, int steps) {
  Flown flown;
  flown.history.step_s = 0.1;
  FlightOptions options;
  options.scheme = scheme;
  options.steps_per_tick = steps;
  // Timed without the history; the fastest of a few, because other work only ever slows a run.
  flown.cpu_s = INFINITY;
  for (int repeat = 0; repeat < (scheme == Scheme::kCvode ? 1 : 3); ++repeat) {
    const std::clock_t start = std::clock();
    flown.result = Fly(model, inputs, options);
    const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (took < flown.cpu_s) flown.cpu_s = took;
  }
  options.history = &flown.history;
  flown.result = Fly(model, inputs, options);
  return flown;
}

double LargestDifference(const History& a, const History& b, int column) {
  double largest = 0.0;
  const std::size_t rows = a.rows() < b.rows() ? a.rows() : b.rows();
  for (std::size_t row = 0; row < rows; ++row)
    largest = std::fmax(largest, std::fabs(a.at(row, column) - b.at(row, column)));
  return largest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: work_precision CAMPAIGNS_FOLDER\n");
    return 2;
  }
  const int pitch_error = FindHistoryColumn("pitch_error_deg");
  std::printf(
      "case,tick_s,scheme,steps_per_tick,cpu_s,altitude_difference_m,velocity_difference_m_s,"
      "pitch_error_difference_deg,pitch_error_rms_deg\n");
  for (const bool dispersed : {false, true}) {
    const FlightInputs inputs = dispersed ? Table3Inputs() : FlightInputs{};
    for (const double tick_s : {0.005, 0.01, 0.02}) {
      FlightDefinition definition = Slv4Definition(argv[1]);
      definition.autopilot.tick_s = tick_s;
      const FlightModel model(definition);
      const Flown exact = FlyOnce(model, inputs, Scheme::kCvode, 1);
      const auto print = [&](const char* scheme, int steps, const Flown& flown) {
        std::printf("%s,%g,%s,%d,%.4f,%.3e,%.3e,%.3e,%.6f\n", dispersed ? "table3" : "nominal", tick_s,
                    scheme, steps, flown.cpu_s,
                    1e3 * std::fabs(MetricOf(flown.result, "injection_altitude_km") -
                                    MetricOf(exact.result, "injection_altitude_km")),
                    std::fabs(MetricOf(flown.result, "injection_velocity_m_s") -
                              MetricOf(exact.result, "injection_velocity_m_s")),
                    LargestDifference(flown.history, exact.history, pitch_error),
                    MetricOf(flown.result, "pitch_error_rms_deg"));
        std::fflush(stdout);
      };
      print("cvode", 0, exact);
      for (const int steps : {1, 2, 4, 8}) print("erk4", steps, FlyOnce(model, inputs, Scheme::kRungeKutta4, steps));
    }
  }
  return 0;
}
