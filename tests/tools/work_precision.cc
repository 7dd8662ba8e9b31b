#include "tests/tools/work_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "tests/slv4_flight.h"
#include "tests/tools/sheets.h"

namespace dispersa {
namespace {

struct Flown {
  FlightResult result;
  History history;
  double cpu_s = std::numeric_limits<double>::infinity();
};

Flown FlyOnce(const FlightModel& model, const FlightInputs& inputs, Scheme scheme, int steps) {
  Flown flown;
  flown.history.step_s = 0.1;
  FlightOptions options;
  options.scheme = scheme;
  options.steps_per_tick = steps;
  // Timed without the history; the fastest of a few, because other work only ever slows a run.
  for (int repeat = 0; repeat < 3; ++repeat) {
    const std::clock_t start = std::clock();
    flown.result = Fly(model, inputs, options);
    flown.cpu_s = std::min(flown.cpu_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  options.history = &flown.history;
  flown.result = Fly(model, inputs, options);
  return flown;
}

double LargestDifference(const History& a, const History& b, int column) {
  double largest = 0.0;
  for (std::size_t row = 0; row < std::min(a.rows(), b.rows()); ++row)
    largest = std::max(largest, std::fabs(a.at(row, column) - b.at(row, column)));
  return largest;
}

WorkPoint Compare(const Flown& flown, const Flown& exact) {
  const auto differ = [&](const char* metric) {
    return std::fabs(MetricOf(flown.result, metric) - MetricOf(exact.result, metric));
  };
  WorkPoint point;
  point.cpu_s = flown.cpu_s;
  point.altitude_difference_m = 1e3 * differ("injection_altitude_km");
  point.velocity_difference_m_s = differ("injection_velocity_m_s");
  point.pitch_error_difference_deg =
      LargestDifference(flown.history, exact.history, FindHistoryColumn("pitch_error_deg"));
  point.pitch_error_rms_deg = MetricOf(flown.result, "pitch_error_rms_deg");
  point.pitch_error_peak_deg = MetricOf(flown.result, "pitch_error_peak_deg");
  return point;
}

// A discrete law whose spreading would overshoot the mean within a tick is limited to the tick.
AutopilotConfig WithTick(AutopilotConfig autopilot, double tick_s) {
  autopilot.tick_s = tick_s;
  for (AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll})
    axis->adaptation.spread_1_s = std::min(axis->adaptation.spread_1_s, 1.0 / tick_s);
  return autopilot;
}

// From the decade below the least positive value of Table 3's flights to the one above the largest.
ChartAxis WholeDecades(const std::string& label, const std::vector<WorkPoint>& points,
                       double WorkPoint::*difference) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const WorkPoint& p : points) {
    if (p.flight != "table3" || !(p.*difference > 0.0)) continue;
    low = std::min(low, p.*difference);
    high = std::max(high, p.*difference);
  }
  return {.label = label,
          .low = std::pow(10.0, std::floor(std::log10(low))),
          .high = std::pow(10.0, std::ceil(std::log10(high))),
          .logarithmic = true};
}

const char* SchemeName(Scheme scheme) {
  return scheme == Scheme::kCvode ? "cvode" : scheme == Scheme::kSimpson ? "simpson" : "erk4";
}

std::string TickName(double tick_s) { return fmt::format("{:g} ms", 1e3 * tick_s); }

}  // namespace

std::vector<WorkPoint> MeasureWorkPrecision(const std::string& campaigns) {
  const FlightDefinition shipped = Slv4Definition(campaigns);
  std::vector<WorkPoint> points;
  for (const bool dispersed : {false, true}) {
    const FlightInputs inputs = dispersed ? Table3Inputs() : FlightInputs{};
    for (const double tick_s : {0.0025, 0.005, 0.01, 0.02}) {
      FlightDefinition definition = shipped;
      definition.autopilot = WithTick(shipped.autopilot, tick_s);
      const FlightModel model(definition);
      const Flown exact = FlyOnce(model, inputs, Scheme::kCvode, 1);
      const auto add = [&](const Flown& flown, Scheme scheme, int steps) {
        WorkPoint point = Compare(flown, exact);
        point.flight = dispersed ? "table3" : "nominal";
        point.tick_s = tick_s;
        point.scheme = scheme;
        point.steps = steps;
        points.push_back(point);
      };
      add(exact, Scheme::kCvode, 0);
      for (const int steps : {1, 2, 4})
        add(FlyOnce(model, inputs, Scheme::kSimpson, steps), Scheme::kSimpson, steps);
      if (tick_s == kShippedTick_s)
        add(FlyOnce(model, inputs, Scheme::kRungeKutta4, 1), Scheme::kRungeKutta4, 1);
    }
  }
  return points;
}

std::string WorkPrecisionCsv(const std::vector<WorkPoint>& points) {
  std::string csv =
      "flight,tick_s,scheme,steps_per_tick,cpu_s,altitude_difference_m,velocity_difference_m_s,"
      "pitch_error_difference_deg,pitch_error_rms_deg,pitch_error_peak_deg\n";
  for (const WorkPoint& p : points)
    csv += fmt::format("{},{},{},{},{:.4f},{:.3e},{:.3e},{:.3e},{:.6f},{:.6f}\n", p.flight, p.tick_s,
                       SchemeName(p.scheme), p.steps, p.cpu_s, p.altitude_difference_m,
                       p.velocity_difference_m_s, p.pitch_error_difference_deg, p.pitch_error_rms_deg,
                       p.pitch_error_peak_deg);
  return csv;
}

FigureSheet WorkPrecisionSheet(const std::vector<WorkPoint>& points) {
  FigureSheet sheet{
      .title = "Work and precision of a whole closed-loop flight, every dispersion of Table 3 at once",
      .panels = {}};
  const ChartAxis cpu{
      .label = "CPU time of a flight alone, ms", .low = 10.0, .high = 1e4, .logarithmic = true};
  const auto work = [&](const std::string& label, double WorkPoint::*difference, const std::string& caption) {
    SvgChart chart = PanelChart(cpu, WholeDecades(label, points, difference));
    std::vector<double> shipped_x, shipped_y, cvode_x, cvode_y;
    std::vector<std::pair<double, std::vector<WorkPoint>>> ticks;
    for (const WorkPoint& p : points) {
      if (p.flight != "table3") continue;
      if (ticks.empty() || ticks.back().first != p.tick_s) ticks.push_back({p.tick_s, {}});
      ticks.back().second.push_back(p);
      if (IsShipped(p)) {
        shipped_x = {1e3 * p.cpu_s};
        shipped_y = {p.*difference};
      }
    }
    chart.Points(shipped_x, shipped_y, "shipped", "shipped: 10 ms tick, 1 step");
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      std::vector<double> x, y_values;
      for (const WorkPoint& p : ticks[i].second) {
        if (p.scheme != Scheme::kSimpson) continue;
        x.push_back(1e3 * p.cpu_s);
        y_values.push_back(p.*difference);
      }
      // Two solutions that agree no better than this cannot tell which of them is nearer to the truth.
      cvode_x.push_back(1e3 * ticks[i].second.front().cpu_s);
      cvode_y.push_back(y_values.back());
      const std::string style = std::to_string(i);
      chart.Line(x, y_values, "line-" + style, "");
      chart.Points(x, y_values, "dots-" + style, TickName(ticks[i].first));
    }
    chart.Points(cvode_x, cvode_y, "public", "CVODE 1e-12, floor");
    sheet.panels.push_back({chart, caption});
  };
  work("largest difference in pitch error, °", &WorkPoint::pitch_error_difference_deg,
       "The engine's step, 1, 2 and 4 steps a tick against CVODE on the same tick; CVODE's own points are "
       "placed at "
       "its difference to 4 steps a tick, the floor of the comparison.");
  work("difference in injection altitude, m", &WorkPoint::altitude_difference_m,
       "The same for the injection altitude.");

  SvgChart tick = PanelChart({.label = "tick of the autopilot, ms", .low = 0.0, .high = 22.0},
                             {.label = "pitch error, °", .low = 0.0});
  for (const bool dispersed : {true, false}) {
    std::vector<double> x, rms, peak;
    for (const WorkPoint& p : points) {
      if (p.scheme != Scheme::kSimpson || p.steps != kShippedSteps || (p.flight == "table3") != dispersed)
        continue;
      x.push_back(1e3 * p.tick_s);
      rms.push_back(p.pitch_error_rms_deg);
      peak.push_back(p.pitch_error_peak_deg);
    }
    const std::string name = dispersed ? "Table 3" : "nominal";
    const std::string a = dispersed ? "0" : "2", b = dispersed ? "1" : "3";
    tick.Line(x, peak, "line-" + b, "");
    tick.Points(x, peak, "dots-" + b, name + ", peak");
    tick.Line(x, rms, "line-" + a, "");
    tick.Points(x, rms, "dots-" + a, name + ", RMS");
  }
  tick.Mark(1e3 * kShippedTick_s, "shipped");
  sheet.panels.push_back(
      {tick, "What the tick does to the controller, gains held: the delay of one tick grows with it."});
  return sheet;
}

}  // namespace dispersa
