#include "core/report/metric_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace dispersa {
namespace {

struct UnitSuffix {
  std::string_view suffix;
  std::string_view unit;
};

/// Longer suffixes before those that end them.
constexpr std::array<UnitSuffix, 19> kUnits = {{
    {"_itae_deg_s2", "° s²"},
    {"_deg_s2", "°/s²"},
    {"_pa_rad", "Pa rad"},
    {"_deg_s", "°/s"},
    {"_rad_s", "rad/s"},
    {"_kg_s", "kg/s"},
    {"_km_s", "km/s"},
    {"_m_s", "m/s"},
    {"_deg", "°"},
    {"_rad", "rad"},
    {"_pa", "Pa"},
    {"_km", "km"},
    {"_kg", "kg"},
    {"_ms", "ms"},
    {"_db", "dB"},
    {"_n", "N"},
    {"_m", "m"},
    {"_g", "g"},
    {"_s", "s"},
}};

struct Entry {
  std::string_view stem;  ///< without stage and unit
  std::string_view title;
  std::string_view definition;
  Worse worse = Worse::kLarger;
};

constexpr std::array<Entry, 36> kEntries = {{
    {"pitch_error_rms", "Pitch error, RMS",
     "root mean square over powered flight of the component about body y of the rotation from the reference "
     "attitude to the true one"},
    {"pitch_error_peak", "Pitch error, peak", "largest magnitude of the same error over powered flight"},
    {"pitch_error_peak_time", "Time of the pitch error's peak", "since lift-off", Worse::kNeither},
    {"pitch_error_itae", "Pitch error, ITAE",
     "integral over powered flight of time times magnitude of the error"},
    {"yaw_error_rms", "Yaw error, RMS", "about body z, over powered flight"},
    {"yaw_error_peak", "Yaw error, peak", "largest magnitude about body z over powered flight"},
    {"roll_error_rms", "Roll error, RMS", "about body x, over powered flight"},
    {"roll_error_peak", "Roll error, peak", "largest magnitude about body x over powered flight"},
    {"deflection_peak", "Deflection, peak", "largest magnitude of any nozzle's angle"},
    {"deflection_rms", "Deflection, RMS", "root mean square over the nozzles and powered flight"},
    {"deflection_rate_peak", "Deflection rate, peak", "largest magnitude of any nozzle's rate"},
    {"deflection_saturated_fraction", "Deflection saturated",
     "fraction of powered flight in which a nozzle is commanded to its limit"},
    {"deflection_travel", "Deflection travel",
     "path of a nozzle added up, mean of the four: wear of the actuators"},
    {"deflection_limit_cycle", "Limit cycle of the deflection",
     "worst peak-to-peak deflection, detrended over sliding 1 s windows, from 5 s after each ignition, "
     "outside "
     "the kick and gusts"},
    {"q_max", "Dynamic pressure, maximum", ""},
    {"q_alpha_max", "Product of dynamic pressure and incidence, maximum", ""},
    {"alpha_max", "Incidence as flown, maximum", "where the dynamic pressure is at least 1 kPa"},
    {"axial_load_max", "Axial load, maximum", "specific force along the body axis"},
    {"lateral_load_max", "Lateral load, maximum",
     "specific force normal to the body axis at the centre of gravity"},
    {"structural_limit_exceeded", "Structural limit exceeded",
     "1 when a limit of the vehicle file was exceeded"},
    {"handover_attitude_error", "Attitude error at the last ignition",
     "magnitude of the rotation that the reaction control leaves to the gimbals"},
    {"handover_rate_error", "Rate error at the last ignition", "magnitude, likewise"},
    {"injection_altitude", "Injection altitude", "geodetic, at the end of the last burn", Worse::kNeither},
    {"injection_velocity", "Injection velocity", "inertial, at the end of the last burn", Worse::kNeither},
    {"injection_flight_path_angle", "Injection flight path angle", "inertial, at the end of the last burn",
     Worse::kFartherFromZero},
    {"injection_altitude_error", "Injection altitude error", "against the target", Worse::kFartherFromZero},
    {"injection_velocity_error", "Injection velocity error", "against the target", Worse::kFartherFromZero},
    {"injection_flight_path_angle_error", "Injection flight path angle error", "against the target",
     Worse::kFartherFromZero},
    {"apogee", "Apogee", "altitude over the equatorial radius of the osculating orbit at injection",
     Worse::kNeither},
    {"perigee", "Perigee", "altitude over the equatorial radius of the osculating orbit at injection",
     Worse::kSmaller},
    {"inclination", "Inclination", "of the osculating orbit at injection", Worse::kNeither},
    {"rcs_propellant", "Reaction control propellant", "used in the coast"},
    {"lyapunov_outside_fraction", "Outside the residual set",
     "fraction of powered flight with the pitch law's V above that of 0.05 deg of error"},
    {"lyapunov_decreasing_fraction", "Lyapunov function decreasing",
     "fraction of the powered flight outside the residual set", Worse::kSmaller},
    {"adaptation_norm_peak", "Adaptation, largest norm",
     "distance of the pitch rules' consequents from their start"},
    {"rules_fired", "Rules fired", "pitch rules that were active at any time", Worse::kNeither},
}};

/// Takes "_stage2" or "_coast" out of a stem and says it in words.
std::string TakePhase(std::string* stem) {
  if (const std::size_t at = stem->find("_coast"); at != std::string::npos) {
    stem->erase(at, 6);
    return ", coast";
  }
  const std::size_t at = stem->find("_stage");
  if (at == std::string::npos || at + 6 >= stem->size()) return "";
  const std::string stage = stem->substr(at + 6, 1);
  stem->erase(at, 7);
  return ", stage " + stage;
}

}  // namespace

NameAndUnit SplitUnit(const std::string& name) {
  for (const UnitSuffix& unit : kUnits) {
    if (name.ends_with(unit.suffix)) {
      // ITAE is an integral over time twice, so its suffix reads otherwise than an acceleration's.
      const std::size_t kept = unit.suffix.starts_with("_itae") ? 5 : 0;
      return {name.substr(0, name.size() - unit.suffix.size() + kept), std::string(unit.unit)};
    }
  }
  return {name, ""};
}

MetricInfo DescribeMetric(const std::string& name) {
  MetricInfo info;
  NameAndUnit split = SplitUnit(name);
  info.unit = split.unit;
  const std::string phase = TakePhase(&split.stem);
  const auto* entry = std::find_if(kEntries.begin(), kEntries.end(),
                                   [&](const Entry& candidate) { return candidate.stem == split.stem; });
  if (entry != kEntries.end()) {
    info.title = entry->title;
    info.definition = entry->definition;
    info.worse = entry->worse;
    info.known = true;
  } else {
    info.title = split.stem;
    std::replace(info.title.begin(), info.title.end(), '_', ' ');
    if (!info.title.empty() && info.title[0] >= 'a')
      info.title[0] = static_cast<char>(info.title[0] - 'a' + 'A');
  }
  info.title += phase;
  return info;
}

double Badness(Worse worse, double value) {
  switch (worse) {
    case Worse::kLarger:
    case Worse::kNeither:
      return value;
    case Worse::kSmaller:
      return -value;
    case Worse::kFartherFromZero:
      return std::fabs(value);
  }
  return value;
}

}  // namespace dispersa
