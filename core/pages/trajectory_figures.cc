#include "core/pages/trajectory_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/environment/earth.h"
#include "core/flight/orbit.h"
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

/// Drag alone is thousandths of a g in the coast.
constexpr double kThrust_g = 0.5;

/// A stage's first and last sample with thrust, by their place in the history.
struct Burn {
  int stage;
  std::size_t ignition, burnout;
};

std::vector<Burn> BurnsIn(const std::vector<AscentSample>& history) {
  std::vector<Burn> burns;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i].axial_load_g < kThrust_g) continue;
    if (burns.empty() || history[i].stage != burns.back().stage) burns.push_back({history[i].stage, i, i});
    burns.back().burnout = i;
  }
  return burns;
}

/// Marks ignitions, and gaps of more than 20 s without thrust as coast.
void MarkStages(const std::vector<AscentSample>& history, SvgChart* chart) {
  double burnout_s = 0.0;
  for (const Burn& burn : BurnsIn(history)) {
    const double ignition_s = history[burn.ignition].time_s;
    if (burnout_s > 0.0 && ignition_s - burnout_s > 20.0) chart->Shade(burnout_s, ignition_s, "coast");
    chart->Mark(ignition_s, fmt::format("S{}", burn.stage));
    burnout_s = history[burn.burnout].time_s;
  }
}

/// Above the equator's radius; the apogee is infinite if the orbit is unbound.
struct Apsides {
  double apogee_km, perigee_km;
};

Apsides ApsidesOf(const AscentSample& s) {
  const auto orbit = ElementsOf(Wgs84(), s.p_EoC_I, s.v_IC_I);
  return {orbit.apogee_altitude_m * 1e-3, orbit.perigee_altitude_m * 1e-3};
}

/// Burns and the largest dynamic pressure, in the order of time.
std::vector<std::pair<std::size_t, std::string>> EventsIn(const std::vector<AscentSample>& history) {
  std::vector<std::pair<std::size_t, std::string>> events;
  const std::vector<Burn> burns = BurnsIn(history);
  for (const Burn& burn : burns) {
    const std::string stage = fmt::format(" of stage {}", burn.stage);
    events.emplace_back(burn.ignition, (burn.ignition == 0 ? "lift-off, ignition" : "ignition") + stage);
    if (burn.burnout + 1 < history.size()) events.emplace_back(burn.burnout, "end of the burn" + stage);
  }
  const auto hardest =
      std::max_element(history.begin(), history.end(),
                       [](const AscentSample& a, const AscentSample& b) { return a.qbar_pa < b.qbar_pa; });
  events.emplace_back(hardest - history.begin(), "largest dynamic pressure");
  events.emplace_back(history.size() - 1, AscentEndWords(history));
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return events;
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
  add("dynamic pressure, kPa", Column(history, [](const AscentSample& s) { return s.qbar_pa * 1e-3; }),
      "Dynamic pressure of the air.");
  SvgChart apsides({.label = kSinceLiftOff}, {.label = "altitude above the equator’s radius, km"});
  MarkStages(history, &apsides);
  // On the ground and long after the perigee is kilometres above the centre: it would flatten the chart.
  constexpr double kLeastPerigeeKm = -2000.0, kNotDrawn = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> apogee, perigee;
  for (const AscentSample& sample : history) {
    const auto [apogee_km, perigee_km] = ApsidesOf(sample);
    apogee.push_back(std::isfinite(apogee_km) ? apogee_km : kNotDrawn);
    perigee.push_back(perigee_km < kLeastPerigeeKm ? kNotDrawn : perigee_km);
  }
  apsides.Line(time_s, std::move(apogee), "line-0", "apogee");
  apsides.Line(time_s, std::move(perigee), "line-1", "perigee");
  figures += Draw(
      std::move(apsides),
      "Apogee and perigee of the two-body orbit at each instant; a perigee below −2000 km is not drawn.");
  return figures;
}

const char* AscentEndWords(const std::vector<AscentSample>& history) {
  return history.empty() || ApsidesOf(history.back()).perigee_km > 0.0 ? "injection" : "end of the ascent";
}

std::string AscentEventsTable(const std::vector<AscentSample>& history) {
  if (history.empty()) return "";
  HtmlTable table(
      "Event|#Time, s|#Height, km|#Speed, m/s|#Dynamic pressure, kPa|#Mass, kg|#Apogee, km|#Perigee, km");
  const auto text = [](double value) {
    return std::isfinite(value) ? FixedText(value, 1) : std::string("none");
  };
  for (const auto& [at, name] : EventsIn(history)) {
    const AscentSample& s = history[at];
    const Apsides apsides = ApsidesOf(s);
    table.Row({HtmlText(name), text(s.time_s), text(s.altitude_m * 1e-3), text(s.velocity_m_s),
               FixedText(s.qbar_pa * 1e-3, 2), text(s.mass_kg), text(apsides.apogee_km),
               text(apsides.perigee_km)});
  }
  return table.Html();
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
