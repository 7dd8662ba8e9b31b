#include "core/pages/trajectory_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kSinceLiftOff[] = "time since lift-off, s";

template <typename Value>
std::vector<double> Column(const std::vector<AscentSample>& history, Value value) {
  std::vector<double> column;
  for (const AscentSample& sample : history) column.push_back(value(sample));
  return column;
}

double TimeOf(const AscentSample& sample) { return sample.time_s; }

/// Marks ignitions, and gaps of more than 20 s without thrust as coast.
void MarkStages(const std::vector<AscentSample>& history, SvgChart* chart) {
  constexpr double kThrust_g = 0.5;  // drag alone is thousandths of a g in the coast
  int marked = 0;
  double burnout_s = 0.0;
  for (const AscentSample& sample : history) {
    if (sample.axial_load_g < kThrust_g) continue;
    if (sample.stage != marked) {
      if (marked > 0 && sample.time_s - burnout_s > 20.0) chart->Shade(burnout_s, sample.time_s, "coast");
      marked = sample.stage;
      chart->Mark(sample.time_s, fmt::format("S{}", marked));
    }
    burnout_s = sample.time_s;
  }
}

std::string Draw(SvgChart chart, const std::string& caption) {
  return Figure(chart.Svg(caption), HtmlText(caption));
}

}  // namespace

std::string FlightProgramFigures(const FlightProgram& program, const std::vector<AscentSample>& history) {
  const std::vector<double> time_s = Column(history, TimeOf);
  const std::vector<double> alpha_deg =
      Column(history, [](const AscentSample& s) { return s.alpha_rad * kDegPerRad; });
  SvgChart whole({.label = kSinceLiftOff}, {.label = "programmed angle of attack, °"});
  MarkStages(history, &whole);
  whole.Line(time_s, alpha_deg, "line-0", "");
  SvgChart kick({.label = kSinceLiftOff, .low = 0.0, .high = std::ceil(program.t2_s / 5.0 + 0.5) * 5.0},
                {.label = "programmed angle of attack, °"});
  kick.Mark(program.t1_s, "t1");
  kick.Mark(program.t3_s, "t3");
  kick.Mark(program.t2_s, "t2");
  kick.Line(time_s, alpha_deg, "line-0", "");
  const int stages = history.empty() ? 1 : history.back().stage;
  return Draw(std::move(whole),
              stages > 1 ? fmt::format("Flight program over the whole flight; S1 to S{}: ignitions.", stages)
                         : std::string("Flight program over the whole flight; S1: ignition.")) +
         Draw(std::move(kick), "Flight program in the initial pitch-over, with t1, t3 and t2.");
}

std::string ReferenceFigures(const std::vector<AscentSample>& history) {
  const std::vector<double> time_s = Column(history, TimeOf);
  std::string figures;
  const auto add = [&](const char* label, std::vector<double> values, const std::string& caption) {
    SvgChart chart({.label = kSinceLiftOff}, {.label = label});
    MarkStages(history, &chart);
    chart.Line(time_s, std::move(values), "line-0", "");
    figures += Draw(std::move(chart), caption);
  };
  add("pitch, °", Column(history, [](const AscentSample& s) { return s.pitch_rad * kDegPerRad; }),
      "Pitch angle from the launch horizon, in the frame frozen at lift-off.");
  add("height, km", Column(history, [](const AscentSample& s) { return s.altitude_m * 1e-3; }),
      "Geodetic height.");
  add("velocity, m/s", Column(history, [](const AscentSample& s) { return s.velocity_m_s; }),
      "Inertial speed; at lift-off it is that of the Earth's rotation.");
  add("flight path angle, °",
      Column(history, [](const AscentSample& s) { return s.flight_path_angle_rad * kDegPerRad; }),
      "Inertial flight path angle, above the plane normal to the radius.");
  return figures;
}

std::string AscentCsv(const std::vector<AscentSample>& history) {
  std::string csv =
      "time_s,stage,altitude_m,velocity_m_s,relative_velocity_m_s,flight_path_angle_deg,relative_path_angle_"
      "deg,"
      "alpha_deg,pitch_deg,yaw_deg,roll_deg,mach,qbar_pa,axial_load_g,mass_kg\n";
  for (const AscentSample& s : history) {
    csv += ShortestText(s.time_s) + "," + std::to_string(s.stage);
    for (const double value :
         {s.altitude_m, s.velocity_m_s, s.relative_velocity_m_s, s.flight_path_angle_rad * kDegPerRad,
          s.relative_path_angle_rad * kDegPerRad, s.alpha_rad * kDegPerRad, s.pitch_rad * kDegPerRad,
          s.yaw_rad * kDegPerRad, s.roll_rad * kDegPerRad, s.mach, s.qbar_pa, s.axial_load_g, s.mass_kg}) {
      csv += "," + ShortestText(value);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace dispersa
