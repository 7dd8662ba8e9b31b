#include "core/flight/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/flight/flight_model.h"
#include "core/flight/flight_sums.h"
#include "core/flight/structural_limits.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

double Rms(const ErrorSums& e) { return e.count > 0.0 ? Sqrt(e.squares / e.count) * kDegPerRad : kUndefined; }
double Peak(const ErrorSums& e) { return e.count > 0.0 ? e.peak * kDegPerRad : kUndefined; }
double Swing(double rad) { return rad >= 0.0 ? rad * kDegPerRad : kUndefined; }
double Ratio(double part, double whole) { return whole > 0.0 ? part / whole : kUndefined; }

// What a metric is computed from.
struct Measured {
  const FlightSums& sums;
  const FlightDefinition& definition;
  const ErrorSums& pitch;  // of the metric's phase

  /// Of a flight that got there.
  double AtHandover(double value) const { return sums.handed_over ? value : kUndefined; }
  double Guided(double value) const { return sums.guidance.acted ? value : kUndefined; }
  double AtInjection(double value) const {
    return sums.injected && std::isfinite(value) ? value : kUndefined;
  }
};

struct Row {
  const char* stem;
  const char* unit;
  const char* title;
  const char* definition;
  Worse worse;
  double (*value)(const Measured&);
};

constexpr auto kLarger = Worse::kLarger, kSmaller = Worse::kSmaller, kAnyway = Worse::kNeither,
               kFarther = Worse::kFartherFromZero;

// Of powered flight, of each stage's burn and of the coast.
constexpr Row kByPhase[] = {
    {"pitch_error_rms", "_deg", "Pitch error, RMS",
     "root mean square over powered flight of the component about body y of the rotation from the reference "
     "attitude to the true one",
     kLarger, [](const Measured& m) { return Rms(m.pitch); }},
    {"pitch_error_peak", "_deg", "Pitch error, peak",
     "largest magnitude of the same error over powered flight", kLarger,
     [](const Measured& m) { return Peak(m.pitch); }},
    {"pitch_error_peak_time", "_s", "Time of the pitch error's peak", "since lift-off", kAnyway,
     [](const Measured& m) { return m.pitch.count > 0.0 ? m.pitch.peak_time_s : kUndefined; }},
};

constexpr Row kOfFlight[] = {
    {"pitch_error_itae", "_deg_s2", "Pitch error, ITAE",
     "integral over powered flight of time times magnitude of the error", kLarger,
     [](const Measured& m) { return m.sums.itae_rad_s2 * kDegPerRad; }},
    {"yaw_error_rms", "_deg", "Yaw error, RMS", "about body z, over powered flight", kLarger,
     [](const Measured& m) { return Rms(m.sums.yaw); }},
    {"yaw_error_peak", "_deg", "Yaw error, peak", "largest magnitude about body z over powered flight",
     kLarger, [](const Measured& m) { return Peak(m.sums.yaw); }},
    {"roll_error_rms", "_deg", "Roll error, RMS", "about body x, over powered flight", kLarger,
     [](const Measured& m) { return Rms(m.sums.roll); }},
    {"roll_error_peak", "_deg", "Roll error, peak", "largest magnitude about body x over powered flight",
     kLarger, [](const Measured& m) { return Peak(m.sums.roll); }},

    {"deflection_peak", "_deg", "Deflection, peak", "largest magnitude of any nozzle's angle", kLarger,
     [](const Measured& m) { return Peak(m.sums.deflection); }},
    {"deflection_rms", "_deg", "Deflection, RMS", "root mean square over the nozzles and powered flight",
     kLarger, [](const Measured& m) { return Rms(m.sums.deflection); }},
    {"deflection_rate_peak", "_deg_s", "Deflection rate, peak", "largest magnitude of any nozzle's rate",
     kLarger, [](const Measured& m) { return m.sums.deflection_rate_peak_rad_s * kDegPerRad; }},
    {"deflection_saturated_fraction", "", "Deflection saturated",
     "fraction of powered flight in which a nozzle is commanded to its limit", kLarger,
     [](const Measured& m) { return Ratio(m.sums.saturated_ticks, m.pitch.count); }},
    {"deflection_travel", "_deg", "Deflection travel",
     "path of a nozzle added up, mean of the drives: wear of the actuators", kLarger,
     [](const Measured& m) { return m.sums.travel_rad * kDegPerRad; }},
    {"deflection_ripple", "_deg", "Deflection ripple",
     "worst peak-to-peak deflection, detrended over sliding 1 s windows, from 5 s after each ignition, "
     "outside the kick and gusts: of whatever origin",
     kLarger, [](const Measured& m) { return Swing(m.sums.ripple_rad); }},
    {"deflection_limit_cycle", "_deg", "Limit cycle of the deflection",
     "largest peak-to-peak of a sustained periodic oscillation, 12 to 24 periods of 0.3125 to 10 Hz with one "
     "phase, from 5 s after each ignition, outside the kick and gusts; 0: none",
     kLarger, [](const Measured& m) { return Swing(m.sums.limit_cycle_rad); }},

    {"q_max", "_pa", "Dynamic pressure, maximum", "", kLarger,
     [](const Measured& m) { return m.sums.q_max_pa; }},
    {"q_alpha_max", "_pa_rad", "Product of dynamic pressure and incidence, maximum", "", kLarger,
     [](const Measured& m) { return m.sums.q_alpha_max_pa_rad; }},
    {"alpha_max", "_deg", "Incidence as flown, maximum", "where the dynamic pressure is at least 1 kPa",
     kLarger, [](const Measured& m) { return m.sums.alpha_max_rad * kDegPerRad; }},
    {"axial_load_max", "_g", "Axial load, maximum", "specific force along the body axis", kLarger,
     [](const Measured& m) { return m.sums.axial_load_max_g; }},
    {"lateral_load_max", "_g", "Lateral load, maximum",
     "specific force normal to the body axis at the centre of gravity", kLarger,
     [](const Measured& m) { return m.sums.lateral_load_max_g; }},
    {"bending_moment_max", "_n_m", "Bending moment, maximum",
     "of the cross-sections at eighths of the stack's length: inertia and flow ahead of them, bending "
     "included",
     kLarger,
     [](const Measured& m) {
       return m.sums.bending_moment_max_n_m > 0.0 ? m.sums.bending_moment_max_n_m : kUndefined;
     }},
    {"bending_moment_station", "_m", "Station of the largest bending moment", "aft of the nose tip", kAnyway,
     [](const Measured& m) {
       return m.sums.bending_moment_max_n_m > 0.0 ? m.sums.bending_moment_station_m : kUndefined;
     }},
    {"structural_limit_exceeded", "", "Structural limit exceeded",
     "1 when a limit of the vehicle file was exceeded", kLarger,
     [](const Measured& m) { return ExceedsStructure(m.definition.vehicle.limits, m.sums) ? 1.0 : 0.0; }},

    {"handover_attitude_error", "_deg", "Attitude error at the last ignition",
     "magnitude of the rotation that the reaction control leaves to the gimbals", kLarger,
     [](const Measured& m) { return m.AtHandover(m.sums.handover_angle_rad * kDegPerRad); }},
    {"handover_rate_error", "_deg_s", "Rate error at the last ignition", "magnitude, likewise", kLarger,
     [](const Measured& m) { return m.AtHandover(m.sums.handover_rate_rad_s * kDegPerRad); }},
    {"rcs_propellant", "_kg", "Reaction control propellant",
     "used in coasts, and in roll under thrust where nozzles cannot", kLarger,
     [](const Measured& m) { return m.sums.expelled_kg; }},

    {"injection_altitude", "_km", "Injection altitude", "geodetic, at the end of the last burn", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.injection_altitude_m * 1e-3); }},
    {"injection_velocity", "_m_s", "Injection velocity", "inertial, at the end of the last burn", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.speed_m_s); }},
    {"injection_flight_path_angle", "_deg", "Injection flight path angle",
     "inertial, at the end of the last burn", kFarther,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.flight_path_angle_rad * kDegPerRad); }},
    {"apogee", "_km", "Apogee", "altitude over the equatorial radius of the osculating orbit at injection",
     kAnyway, [](const Measured& m) { return m.AtInjection(m.sums.orbit.apogee_altitude_m * 1e-3); }},
    {"perigee", "_km", "Perigee", "altitude over the equatorial radius of the osculating orbit at injection",
     kSmaller, [](const Measured& m) { return m.AtInjection(m.sums.orbit.perigee_altitude_m * 1e-3); }},
    {"inclination", "_deg", "Inclination", "of the osculating orbit at injection", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.inclination_rad * kDegPerRad); }},
    {"injection_altitude_error", "_km", "Injection altitude error", "against the target", kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.injection_altitude_m - m.definition.target.altitude_m) * 1e-3);
     }},
    {"injection_velocity_error", "_m_s", "Injection velocity error", "against the target", kFarther,
     [](const Measured& m) {
       return m.AtInjection(m.sums.orbit.speed_m_s - m.definition.target.velocity_m_s);
     }},
    {"injection_flight_path_angle_error", "_deg", "Injection flight path angle error", "against the target",
     kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.orbit.flight_path_angle_rad - m.definition.target.flight_path_angle_rad) *
                            kDegPerRad);
     }},

    {"lyapunov_outside_fraction", "", "Outside the residual set",
     "fraction of powered flight with the pitch law's V above that of 0.05 deg of error", kLarger,
     [](const Measured& m) { return Ratio(m.sums.v_outside_ticks, m.pitch.count); }},
    {"lyapunov_decreasing_fraction", "", "Lyapunov function decreasing",
     "fraction of the powered flight outside the residual set", kSmaller,
     [](const Measured& m) { return Ratio(m.sums.v_falling_ticks, m.sums.v_outside_ticks); }},
    {"adaptation_norm_peak", "_deg_s2", "Adaptation, largest norm",
     "distance of the pitch rules' consequents from their start", kLarger,
     [](const Measured& m) { return m.sums.adaptation_peak_rad_s2 * kDegPerRad; }},
    {"rules_fired", "", "Rules fired", "pitch rules that were active at any time", kAnyway,
     [](const Measured& m) { return static_cast<double>(std::popcount(m.sums.rules_fired)); }},
};

double SemiMajorAxis(const Earth& earth, double radius_m, double speed_m_s) {
  return 1.0 / (2.0 / radius_m - speed_m_s * speed_m_s / earth.mu_m3_s2);
}

// Of the flight too, outside its digest: they follow from its end, from what led there, or from its inputs.
constexpr Row kOfArrival[] = {
    {"semi_major_axis_error", "_km", "Semi-major axis error",
     "at injection, against that of the target's speed at the target's altitude there", kFarther,
     [](const Measured& m) {
       const OrbitElements& orbit = m.sums.orbit;
       const Earth earth = Wgs84();
       const double target_radius_m =
           orbit.radius_m - m.sums.injection_altitude_m + m.definition.target.altitude_m;
       return m.AtInjection((SemiMajorAxis(earth, orbit.radius_m, orbit.speed_m_s) -
                             SemiMajorAxis(earth, target_radius_m, m.definition.target.velocity_m_s)) *
                            1e-3);
     }},
    {"inclination_error", "_deg", "Inclination error", "at injection, against the reference's orbit",
     kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.orbit.inclination_rad - m.definition.target.inclination_rad) *
                            kDegPerRad);
     }},
    {"guidance_converged", "", "Guidance converged",
     "1 when the last plan reaches the target, and the last in which altitude still counted did; of "
     "closed-loop "
     "guidance",
     kSmaller, [](const Measured& m) { return m.Guided(m.sums.guidance.arrives ? 1.0 : 0.0); }},
    {"guidance_ignition_shift", "_s", "Last ignition, moved by guidance", "against the reference", kAnyway,
     [](const Measured& m) { return m.Guided(m.sums.guidance.ignition_shift_s); }},
    {"guidance_postponement", "_s", "Last ignition, postponed", "because the attitude had not settled",
     kLarger, [](const Measured& m) { return m.Guided(m.sums.guidance.postponed_s); }},
    {"guidance_excess_velocity", "_m_s", "Excess velocity",
     "of the last burn, that its turn in yaw takes away, as planned at ignition", kAnyway,
     [](const Measured& m) { return m.Guided(m.sums.guidance.excess_m_s); }},
    {"step_limit_fraction", "", "Fastest part, of what a step resolves",
     "frequency of the actuator or bending mode, as dispersed, that comes nearest to the limit of the "
     "integration's "
     "step, as a fraction of that limit",
     kLarger, [](const Measured& m) { return m.sums.step_limit_fraction; }},
};

// The phases of kByPhase: 0 all powered flight, then the stages, then the coast.
constexpr int kPhases = 1 + kMaxStages + 1;

ErrorSums PitchOf(int phase, const FlightSums& sums) {
  if (phase == kPhases - 1) return sums.coast;
  return phase == 0 ? Total(sums.pitch) : sums.pitch[phase - 1];
}
std::string PhaseName(int phase) {
  if (phase == kPhases - 1) return "coast";
  return phase == 0 ? "" : "stage" + std::to_string(phase);
}
std::string PhaseTitle(int phase) {
  if (phase == kPhases - 1) return ", coast";
  return phase == 0 ? "" : ", stage " + std::to_string(phase);
}

// f(row, phase) for each metric in the order of the columns: of stages that few vehicles have behind all
// others.
template <class F>
void ForEach(F f) {
  const auto is_rare = [](int phase) { return phase > kUsualStages && phase <= kMaxStages; };
  for (int phase = 0; phase < kPhases; ++phase)
    if (!is_rare(phase))
      for (const Row& row : kByPhase) f(row, phase);
  for (const Row& row : kOfFlight) f(row, 0);
  for (const Row& row : kOfArrival) f(row, 0);
  for (int phase = 0; phase < kPhases; ++phase)
    if (is_rare(phase))
      for (const Row& row : kByPhase) f(row, phase);
}
constexpr std::size_t kRareMetrics = (kMaxStages - kUsualStages) * std::size(kByPhase);

}  // namespace

const std::vector<Metric>& Metrics() {
  static const std::vector<Metric> metrics = [] {
    std::vector<Metric> list;
    ForEach([&](const Row& row, int phase) {
      const std::string name = phase == 0 ? row.stem : std::string(row.stem) + "_" + PhaseName(phase);
      list.push_back({name + row.unit, row.title + PhaseTitle(phase), row.definition, row.worse});
    });
    return list;
  }();
  return metrics;
}

const std::vector<std::string>& MetricNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Metric& metric : Metrics()) list.push_back(metric.name);
    return list;
  }();
  return names;
}

std::size_t MetricCount(std::size_t stages) {
  return MetricNames().size() - (stages <= kUsualStages ? kRareMetrics : 0);
}

std::size_t DigestedMetrics() { return MetricCount(kUsualStages) - std::size(kOfArrival); }

std::size_t MetricColumn(const std::string& name) {
  const std::vector<std::string>& names = MetricNames();
  const auto found = std::find(names.begin(), names.end(), name);
  assert(found != names.end());
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<double> MetricsOf(const FlightSums& sums, const FlightDefinition& definition) {
  std::vector<double> values;
  values.reserve(MetricNames().size());
  ForEach([&](const Row& row, int phase) {
    const ErrorSums pitch = PitchOf(phase, sums);
    values.push_back(row.value({sums, definition, pitch}));
  });
  values.resize(MetricCount(definition.vehicle.stages.size()));
  return values;
}

}  // namespace dispersa
