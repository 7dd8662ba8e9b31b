#include "core/flight/metrics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/flight/flight_model.h"
#include "core/flight/flight_sums.h"
#include "core/flight/structural_limits.h"
#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

double Rms(const ErrorSums& e) { return e.count > 0.0 ? Sqrt(e.squares / e.count) * kDegPerRad : kUndefined; }
// Of what is no number nothing is the largest.
double Largest(double magnitude) { return magnitude >= 0.0 ? magnitude : kUndefined; }
double LargestAngle(double rad) { return Largest(rad) * kDegPerRad; }
double Peak(const ErrorSums& e) { return LargestAngle(e.peak); }
double Ratio(double part, double whole) { return whole > 0.0 ? part / whole : kUndefined; }

// The results from which metrics are computed.
struct Measured {
  const FlightSums& sums;
  const FlightDefinition& definition;
  const ErrorSums& pitch;  // of the metric's phase
  int stage;               // of its phase; -1: the whole flight's

  /// The value, if the flight got there.
  double AtHandover(double value) const { return sums.handed_over ? value : kUndefined; }
  double Powered(double value) const { return pitch.count > 0.0 ? value : kUndefined; }
  double Guided(double value) const { return sums.guidance.acted ? value : kUndefined; }
  double AtGuidedIgnition(double value) const { return sums.handed_over ? Guided(value) : kUndefined; }
  double AtInjection(double value) const {
    return sums.injected && std::isfinite(value) ? value : kUndefined;
  }
  double AtApogee(double value) const { return sums.free.has_apogee ? value : kUndefined; }
  double AtImpact(double value) const { return sums.free.has_impact ? value : kUndefined; }
  double OffTheRail(double value) const { return sums.free.left_rail ? value : kUndefined; }
  /// Of the stage's burn, or of the last burn that a command ends.
  double PropellantLeft() const {
    const std::vector<Stage>& stages = definition.vehicle.stages;
    int burn = stage < 0 ? static_cast<int>(stages.size()) - 1 : stage;
    while (stage < 0 && burn >= 0 && !EndsByCommand(stages[static_cast<std::size_t>(burn)].motor)) --burn;
    if (burn < 0 || burn >= sums.burnt_out || !EndsByCommand(stages[static_cast<std::size_t>(burn)].motor))
      return kUndefined;
    return std::max(sums.unburnt_kg[burn], 0.0);
  }
};

// The end of a metric's name, and how people write the unit.
struct MetricUnit {
  const char* suffix;
  const char* text;
};
constexpr MetricUnit kPure{"", ""}, kDegrees{"_deg", "°"}, kDegreesPerSecond{"_deg_s", "°/s"},
    kDegreesPerSecond2{"_deg_s2", "°/s²"}, kDegreeSeconds2{"_deg_s2", "° s²"}, kSeconds{"_s", "s"},
    kMetres{"_m", "m"}, kKilometres{"_km", "km"}, kMetresPerSecond{"_m_s", "m/s"}, kKilograms{"_kg", "kg"},
    kPascals{"_pa", "Pa"}, kPascalRadians{"_pa_rad", "Pa rad"}, kStandardGravities{"_g", "g"},
    kNewtonMetres{"_n_m", "N m"};

// Properties that few metrics have, as in Metric.
struct Traits {
  bool by_stage = false;  // of powered flight, and of each stage's burn
  bool by_coast = false;  // of the coast too
  bool is_usual = false;
  bool is_digested = true;
  bool LawInfo::*of_law = nullptr;
  MetricNeeds needs = MetricNeeds::kNothing;
  Circle circle = {};
  const char* over = nullptr;  // null: as others of its group or its needs
  int since = 1;               // as in Metric
};
constexpr const char *kLastIgnition = "the last ignition",
                     *kLoaded =
                         "lift-off to the end of the last burn, or to the apogee of flights that go on; "
                         "without coasts";
constexpr Traits kByPhase{.by_stage = true, .by_coast = true},
    kUsualByPhase{.by_stage = true, .by_coast = true, .is_usual = true}, kUsual{.is_usual = true},
    kOfRules{.of_law = &LawInfo::rules}, kOfAdaptation{.of_law = &LawInfo::adaptation};
// Follows from the flight's states, which are digested, or from its inputs.
constexpr Traits kNotDigested{.is_digested = false};
// What is not said of flights without a target: the orbit, and how far it is from the target's.
constexpr Traits kOfOrbit{.needs = MetricNeeds::kControl},
    kOfOrbitNotDigested{.is_digested = false, .needs = MetricNeeds::kControl};
constexpr Traits kOfNode{.is_digested = false, .needs = MetricNeeds::kNode, .circle = kCutAt180Deg},
    kOfArgumentOfPerigee{
        .is_digested = false, .needs = MetricNeeds::kArgumentOfPerigee, .circle = kCutAt180Deg},
    kOfTrueAnomaly{.is_digested = false, .needs = MetricNeeds::kTrueAnomaly, .circle = kCutAt180Deg};
constexpr Traits kOfSectionLoads{.needs = MetricNeeds::kSectionLoads},
    kOfLimits{.needs = MetricNeeds::kLimits};
constexpr const char* kCommandedEnd = "the end of the last burn that a command ends";
constexpr Traits kOfCutOff{
    .is_digested = false, .needs = MetricNeeds::kCutOff, .over = kCommandedEnd, .since = 4},
    kOfEachCutOff{.by_stage = true,
                  .is_digested = false,
                  .needs = MetricNeeds::kCutOff,
                  .over = kCommandedEnd,
                  .since = 4};
constexpr Traits kAtHandover{.over = kLastIgnition},
    kAtGuidedIgnition{.is_digested = false, .over = kLastIgnition},
    kOfThrusters{.over = "lift-off to the end of the last burn"};
constexpr Traits kOfFreeStage{.is_digested = false, .needs = MetricNeeds::kFreeStage},
    kOfRail{.is_digested = false, .needs = MetricNeeds::kRail},
    kOfRailSince3{.is_digested = false, .needs = MetricNeeds::kRail, .since = 3},
    kOfApogee{.is_usual = true, .is_digested = false, .needs = MetricNeeds::kApogee},
    kOfImpact{.is_digested = false, .needs = MetricNeeds::kImpact},
    kLongitudeOfImpact{.is_digested = false, .needs = MetricNeeds::kImpact, .circle = kCutAt180Deg},
    kUsualOfImpact{.is_usual = true, .is_digested = false, .needs = MetricNeeds::kImpact};

struct Row {
  const char* stem;
  MetricUnit unit;
  const char* symbol;
  MetricGroup group;
  const char* title;
  const char* definition;
  Worse worse;
  double (*value)(const Measured&);
  Traits traits = {};
};

constexpr auto kLarger = Worse::kLarger, kSmaller = Worse::kSmaller, kAnyway = Worse::kNeither,
               kFarther = Worse::kFartherFromZero;
constexpr auto kAttitude = MetricGroup::kAttitude, kControlEffort = MetricGroup::kControlEffort,
               kLoads = MetricGroup::kLoads, kInjection = MetricGroup::kInjection,
               kFreeFlight = MetricGroup::kFreeFlight, kGuidance = MetricGroup::kGuidance,
               kControlLaw = MetricGroup::kControlLaw, kIntegration = MetricGroup::kIntegration;

double SemiMajorAxis(const Earth& earth, double radius_m, double speed_m_s) {
  return 1.0 / (2.0 / radius_m - speed_m_s * speed_m_s / earth.mu_m3_s2);
}

// In degrees, from -180 to 180.
double AngleError(double is_rad, double wanted_rad) {
  const double error_rad = is_rad - wanted_rad;
  return (error_rad - kTwoPi * std::floor(error_rad / kTwoPi + 0.5)) * kDegPerRad;
}

TargetOrbit OrbitOf(const FlightDefinition& definition) {
  return definition.target.orbit.value_or(TargetOrbit{});
}

// One row a metric. Columns stand in the order of the rows; those of phases come first. A new row goes to the
// end and is not in the digest.
constexpr Row kRows[] = {
    {"pitch_error_rms", kDegrees, "rms e_θ", kAttitude, "Pitch error, RMS",
     "root mean square over powered flight; the error is the body y component of the rotation vector from "
     "the reference attitude to the true one",
     kLarger, [](const Measured& m) { return Rms(m.pitch); }, kUsualByPhase},
    {"pitch_error_peak", kDegrees, "max |e_θ|", kAttitude, "Pitch error, peak",
     "largest magnitude of the pitch error over powered flight", kLarger,
     [](const Measured& m) { return Peak(m.pitch); }, kUsualByPhase},
    {"pitch_error_peak_time", kSeconds, "t(max |e_θ|)", kAttitude, "Time of the pitch error's peak",
     "since lift-off; the first one, if there are several", kAnyway,
     [](const Measured& m) { return m.pitch.peak >= 0.0 ? m.pitch.peak_time_s : kUndefined; }, kByPhase},
    {"pitch_error_itae", kDegreeSeconds2, "∫ t |e_θ| dt", kAttitude, "Pitch error, ITAE",
     "integral over powered flight of time since lift-off times magnitude of the pitch error", kLarger,
     [](const Measured& m) { return m.Powered(m.sums.itae_rad_s2 * kDegPerRad); }},
    {"yaw_error_rms", kDegrees, "rms e_ψ", kAttitude, "Yaw error, RMS",
     "root mean square about body z over powered flight", kLarger,
     [](const Measured& m) { return Rms(m.sums.yaw); }},
    {"yaw_error_peak", kDegrees, "max |e_ψ|", kAttitude, "Yaw error, peak",
     "largest magnitude about body z over powered flight", kLarger,
     [](const Measured& m) { return Peak(m.sums.yaw); }},
    {"roll_error_rms", kDegrees, "rms e_φ", kAttitude, "Roll error, RMS",
     "root mean square about body x over powered flight", kLarger,
     [](const Measured& m) { return Rms(m.sums.roll); }},
    {"roll_error_peak", kDegrees, "max |e_φ|", kAttitude, "Roll error, peak",
     "largest magnitude about body x over powered flight", kLarger,
     [](const Measured& m) { return Peak(m.sums.roll); }},

    {"deflection_peak", kDegrees, "max |δ|", kControlEffort, "Deflection, peak",
     "largest magnitude of any nozzle's angle over powered flight; nozzles in a list count about each hinge",
     kLarger, [](const Measured& m) { return Peak(m.sums.deflection); }, kUsual},
    {"deflection_rms", kDegrees, "rms δ", kControlEffort, "Deflection, RMS",
     "root mean square over the nozzles and powered flight", kLarger,
     [](const Measured& m) { return Rms(m.sums.deflection); }},
    {"deflection_rate_peak", kDegreesPerSecond, "max |dδ/dt|", kControlEffort, "Deflection rate, peak",
     "largest magnitude of any nozzle's rate over powered flight", kLarger,
     [](const Measured& m) { return LargestAngle(m.sums.deflection_rate_peak_rad_s); }},
    {"deflection_saturated_fraction", kPure, "t_sat/t", kControlEffort, "Deflection saturated",
     "fraction of powered flight in which a nozzle is commanded to its limit or beyond", kLarger,
     [](const Measured& m) { return Ratio(m.sums.saturated_ticks, m.pitch.count); }},
    {"deflection_travel", kDegrees, "∫ |dδ|", kControlEffort, "Deflection travel",
     "angle travelled by a drive during burns, mean of all drives; shows the wear of actuators", kLarger,
     [](const Measured& m) { return m.Powered(m.sums.travel_rad * kDegPerRad); }},
    {"deflection_ripple", kDegrees, "δ_pp", kControlEffort, "Deflection ripple",
     "largest peak-to-peak of the pitch, yaw or roll deflection in windows of 1 s (10 per second), minus the "
     "least-squares line; without the first 5 s after an ignition, the kick (t1 to t2) and the gust's "
     "altitudes; of any origin, also turbulence",
     kLarger, [](const Measured& m) { return LargestAngle(m.sums.ripple_rad); }},
    {"deflection_limit_cycle", kDegrees, "δ_lc", kControlEffort, "Limit cycle of the deflection",
     "largest peak-to-peak of a sustained periodic oscillation of the pitch, yaw or roll deflection: 12 to "
     "24 periods of 0.3125 to 10 Hz with one phase, at the times of the deflection ripple; 0: none",
     kLarger, [](const Measured& m) { return LargestAngle(m.sums.limit_cycle_rad); }},

    {"q_max", kPascals, "max q", kLoads, "Dynamic pressure, maximum",
     "largest outside the coast, burnouts included", kLarger,
     [](const Measured& m) { return Largest(m.sums.q_max_pa); }},
    {"q_alpha_max", kPascalRadians, "max qα", kLoads, "Product of dynamic pressure and incidence, maximum",
     "where the dynamic pressure is at least 1 kPa", kLarger,
     [](const Measured& m) { return Largest(m.sums.q_alpha_max_pa_rad); }, kUsual},
    {"alpha_max", kDegrees, "max α", kLoads, "Incidence as flown, maximum",
     "total incidence where the dynamic pressure is at least 1 kPa", kLarger,
     [](const Measured& m) { return LargestAngle(m.sums.alpha_max_rad); }},
    {"axial_load_max", kStandardGravities, "max n_x", kLoads, "Axial load, maximum",
     "specific force (all forces but gravitation) along the body axis, over 9.80665 m/s²; outside the coast, "
     "burnouts included",
     kLarger, [](const Measured& m) { return Largest(m.sums.axial_load_max_g); }},
    {"lateral_load_max", kStandardGravities, "max n_yz", kLoads, "Lateral load, maximum",
     "specific force normal to the body axis at the centre of gravity, over 9.80665 m/s²; outside the coast, "
     "burnouts included",
     kLarger, [](const Measured& m) { return Largest(m.sums.lateral_load_max_g); }},
    {"bending_moment_max", kNewtonMetres, "max M", kLoads, "Bending moment, maximum",
     "largest at the cross-sections where it can be largest (to 0.1 %, beside boosters 1.3 %), from inertia "
     "and flow ahead of them, "
     "with bending; outside the coast",
     kLarger,
     [](const Measured& m) {
       return m.sums.bending_moment_max_n_m > 0.0 ? m.sums.bending_moment_max_n_m : kUndefined;
     },
     kOfSectionLoads},
    {"bending_moment_station", kMetres, "x(max M)", kLoads, "Station of the largest bending moment",
     "aft of the nose tip", kAnyway,
     [](const Measured& m) {
       return m.sums.bending_moment_max_n_m > 0.0 ? m.sums.bending_moment_station_m : kUndefined;
     },
     kOfSectionLoads},
    {"structural_limit_exceeded", kPure, "–", kLoads, "Structural limit exceeded",
     "1 if a limit of the vehicle file was exceeded, else 0", kLarger,
     [](const Measured& m) { return ExceedsStructure(m.definition.vehicle.limits, m.sums) ? 1.0 : 0.0; },
     kOfLimits},

    {"handover_attitude_error", kDegrees, "|e|(t_ign)", kAttitude, "Attitude error at the last ignition",
     "magnitude of the rotation error that the reaction control leaves to the gimbals", kLarger,
     [](const Measured& m) { return m.AtHandover(m.sums.handover_angle_rad * kDegPerRad); }, kAtHandover},
    {"handover_rate_error", kDegreesPerSecond, "|ω_e|(t_ign)", kAttitude, "Rate error at the last ignition",
     "magnitude of the rate error that the reaction control leaves to the gimbals", kLarger,
     [](const Measured& m) { return m.AtHandover(m.sums.handover_rate_rad_s * kDegPerRad); }, kAtHandover},
    {"rcs_propellant", kKilograms, "m_rcs", kControlEffort, "Reaction control propellant",
     "expelled in coasts, and under thrust for roll if the nozzles do not control it", kLarger,
     [](const Measured& m) { return m.sums.expelled_kg; }, kOfThrusters},

    {"injection_altitude", kKilometres, "h", kInjection, "Injection altitude",
     "geodetic, at the end of the last burn", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.injection_altitude_m * 1e-3); }},
    {"injection_velocity", kMetresPerSecond, "V", kInjection, "Injection velocity",
     "inertial, at the end of the last burn", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.speed_m_s); }},
    {"injection_flight_path_angle", kDegrees, "γ", kInjection, "Injection flight path angle",
     "inertial, above the plane normal to the radius, at the end of the last burn", kFarther,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.flight_path_angle_rad * kDegPerRad); }},
    {"apogee", kKilometres, "h_a", kInjection, "Apogee",
     "altitude above the equatorial radius, of the osculating two-body orbit at injection", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.apogee_altitude_m * 1e-3); }, kOfOrbit},
    {"perigee", kKilometres, "h_p", kInjection, "Perigee",
     "altitude above the equatorial radius, of the osculating two-body orbit at injection", kSmaller,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.perigee_altitude_m * 1e-3); }, kOfOrbit},
    {"inclination", kDegrees, "i", kInjection, "Inclination", "of the osculating orbit at injection", kAnyway,
     [](const Measured& m) { return m.AtInjection(m.sums.orbit.inclination_rad * kDegPerRad); }, kOfOrbit},
    {"injection_altitude_error", kKilometres, "Δh", kInjection, "Injection altitude error",
     "altitude at injection minus the target's", kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.injection_altitude_m - m.definition.target.altitude_m) * 1e-3);
     },
     kOfOrbit},
    {"injection_velocity_error", kMetresPerSecond, "ΔV", kInjection, "Injection velocity error",
     "velocity at injection minus the target's", kFarther,
     [](const Measured& m) {
       return m.AtInjection(m.sums.orbit.speed_m_s - m.definition.target.velocity_m_s);
     },
     kOfOrbit},
    {"injection_flight_path_angle_error", kDegrees, "Δγ", kInjection, "Injection flight path angle error",
     "flight path angle at injection minus the target's", kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.orbit.flight_path_angle_rad - m.definition.target.flight_path_angle_rad) *
                            kDegPerRad);
     },
     kOfOrbit},

    {"lyapunov_outside_fraction", kPure, "t(V > V_0)/t", kControlLaw, "Outside the residual set",
     "fraction of powered flight with the pitch law's V = ½ eᵀPe above its value for an error of 0.05° at "
     "rest",
     kLarger, [](const Measured& m) { return Ratio(m.sums.v_outside_ticks, m.pitch.count); }, kOfRules},
    {"lyapunov_decreasing_fraction", kPure, "t(dV < 0)/t(V > V_0)", kControlLaw,
     "Lyapunov function decreasing",
     "fraction of the powered flight outside the residual set in which V is below its value one tick before",
     kSmaller, [](const Measured& m) { return Ratio(m.sums.v_falling_ticks, m.sums.v_outside_ticks); },
     kOfRules},
    {"adaptation_norm_peak", kDegreesPerSecond2, "max ‖Δα̂‖", kControlLaw, "Adaptation, largest norm",
     "largest distance of the pitch rules' consequents from their start", kLarger,
     [](const Measured& m) { return LargestAngle(Sqrt(Largest(m.sums.departure_norm2_peak))); },
     kOfAdaptation},
    {"rules_fired", kPure, "n_rules", kControlLaw, "Rules fired",
     "number of pitch rules that were active at any time", kAnyway,
     [](const Measured& m) { return static_cast<double>(std::popcount(m.sums.rules_fired)); }, kOfRules},

    {"semi_major_axis_error", kKilometres, "Δa", kInjection, "Semi-major axis error",
     "osculating, at injection, minus its value with the target's speed at the target's altitude", kFarther,
     [](const Measured& m) {
       const OrbitElements& orbit = m.sums.orbit;
       const Earth earth = Wgs84();
       const double target_radius_m =
           orbit.radius_m - m.sums.injection_altitude_m + m.definition.target.altitude_m;
       return m.AtInjection((SemiMajorAxis(earth, orbit.radius_m, orbit.speed_m_s) -
                             SemiMajorAxis(earth, target_radius_m, m.definition.target.velocity_m_s)) *
                            1e-3);
     },
     kOfOrbitNotDigested},
    {"inclination_error", kDegrees, "Δi", kInjection, "Inclination error",
     "inclination at injection minus the target's, or the reference's if the target names none", kFarther,
     [](const Measured& m) {
       return m.AtInjection((m.sums.orbit.inclination_rad - m.definition.target.inclination_rad) *
                            kDegPerRad);
     },
     kOfOrbitNotDigested},
    {"guidance_converged", kPure, "–", kGuidance, "Guidance converged",
     "1 if the last guidance plan reaches the target, and also the last plan that controlled altitude, and "
     "the flight is injected, by its navigation, within 1 m/s of the target's energy and 0.02 deg of its "
     "plane; else 0",
     kSmaller,
     [](const Measured& m) { return m.Guided(m.sums.guidance.arrives && m.sums.injected ? 1.0 : 0.0); },
     kNotDigested},
    {"guidance_ignition_shift", kSeconds, "Δt_ign", kGuidance, "Last ignition, moved by guidance",
     "time of the last ignition minus the reference's", kAnyway,
     [](const Measured& m) { return m.AtGuidedIgnition(m.sums.guidance.ignition_shift_s); },
     kAtGuidedIgnition},
    {"guidance_postponement", kSeconds, "t_wait", kGuidance, "Last ignition, postponed",
     "wait of the last ignition until the attitude settled", kLarger,
     [](const Measured& m) { return m.AtGuidedIgnition(m.sums.guidance.postponed_s); }, kAtGuidedIgnition},
    {"guidance_excess_velocity", kMetresPerSecond, "ΔV_x", kGuidance, "Excess velocity",
     "of the last burn, used up by its turn in yaw, as planned at ignition", kAnyway,
     [](const Measured& m) { return m.AtGuidedIgnition(m.sums.guidance.excess_m_s); }, kAtGuidedIgnition},
    {"step_limit_fraction", kPure, "f/f_step", kIntegration, "Fastest part relative to the step limit",
     "largest ratio of the frequency of an actuator or bending mode, as dispersed, to the limit that the "
     "integration step resolves",
     kLarger,
     [](const Measured& m) {
       return m.sums.step_limit_fraction > 0.0 ? m.sums.step_limit_fraction : kUndefined;
     },
     kNotDigested},

    {"apogee_altitude", kKilometres, "h_max", kFreeFlight, "Apogee altitude",
     "geodetic, where altitude stops growing after the last burn", kAnyway,
     [](const Measured& m) { return m.AtApogee(m.sums.free.apogee_altitude_m * 1e-3); }, kOfApogee},
    {"apogee_time", kSeconds, "t(h_max)", kFreeFlight, "Time of the apogee", "since lift-off", kAnyway,
     [](const Measured& m) { return m.AtApogee(m.sums.free.apogee_time_s); }, kOfApogee},
    {"impact_time", kSeconds, "t_imp", kFreeFlight, "Time of the impact", "since lift-off", kAnyway,
     [](const Measured& m) { return m.AtImpact(m.sums.free.impact_time_s); }, kOfImpact},
    {"impact_latitude", kDegrees, "φ_imp", kFreeFlight, "Latitude of the impact", "geodetic", kAnyway,
     [](const Measured& m) { return m.AtImpact(m.sums.free.impact_latitude_rad * kDegPerRad); }, kOfImpact},
    {"impact_longitude", kDegrees, "λ_imp", kFreeFlight, "Longitude of the impact", "east", kAnyway,
     [](const Measured& m) { return m.AtImpact(m.sums.free.impact_longitude_rad * kDegPerRad); },
     kLongitudeOfImpact},
    {"impact_downrange", kKilometres, "x_imp", kFreeFlight, "Impact, down-range",
     "along the great circle of the launch azimuth, from the site", kAnyway,
     [](const Measured& m) { return m.AtImpact(m.sums.free.impact_downrange_m * 1e-3); }, kUsualOfImpact},
    {"impact_crossrange", kKilometres, "y_imp", kFreeFlight, "Impact, cross-range",
     "to the right of the great circle of the launch azimuth", kFarther,
     [](const Measured& m) { return m.AtImpact(m.sums.free.impact_crossrange_m * 1e-3); }, kUsualOfImpact},
    {"impact_speed", kMetresPerSecond, "V_imp", kFreeFlight, "Speed of the impact", "over the ground",
     kLarger, [](const Measured& m) { return m.AtImpact(m.sums.free.impact_speed_m_s); }, kOfImpact},
    {"rail_exit_time", kSeconds, "t_rail", kFreeFlight, "Time off the rail", "since lift-off", kAnyway,
     [](const Measured& m) { return m.OffTheRail(m.sums.free.rail_exit_time_s); }, kOfRail},
    {"rail_exit_speed", kMetresPerSecond, "V_rail", kFreeFlight, "Speed off the rail", "along the rail",
     kSmaller, [](const Measured& m) { return m.OffTheRail(m.sums.free.rail_exit_speed_m_s); }, kOfRail},
    {"roll_rate_peak", kDegreesPerSecond, "max |p|", kFreeFlight, "Roll rate, peak",
     "largest magnitude about the body axis while a stage without gimbal flies", kLarger,
     [](const Measured& m) { return LargestAngle(m.sums.free.roll_rate_peak_rad_s); }, kOfFreeStage},
    {"static_margin_min", kPure, "min (x_CP − x_CG)/d", kFreeFlight, "Static margin, least",
     "centre of pressure aft of the centre of gravity, in diameters, while a stage without gimbal flies and "
     "the dynamic pressure is at least 1 kPa",
     kSmaller,
     [](const Measured& m) {
       return std::isfinite(m.sums.free.least_static_margin) ? m.sums.free.least_static_margin : kUndefined;
     },
     kOfFreeStage},

    {"node_error", kDegrees, "ΔΩ", kInjection, "Node error",
     "right ascension of the ascending node at injection minus the target's", kFarther,
     [](const Measured& m) {
       return m.AtInjection(
           AngleError(m.sums.orbit.ascending_node_rad, m.definition.target.node_rad.value_or(0.0)));
     },
     kOfNode},
    {"argument_of_perigee_error", kDegrees, "Δω", kInjection, "Argument of perigee error",
     "osculating, at injection, minus the target's", kFarther,
     [](const Measured& m) {
       const OrbitElements& orbit = m.sums.orbit;
       return m.AtInjection(AngleError(orbit.argument_of_latitude_rad - orbit.true_anomaly_rad,
                                       OrbitOf(m.definition).argument_of_perigee_rad.value_or(0.0)));
     },
     kOfArgumentOfPerigee},
    {"true_anomaly_error", kDegrees, "Δν", kInjection, "True anomaly error",
     "osculating, at injection, minus the target's", kFarther,
     [](const Measured& m) {
       return m.AtInjection(
           AngleError(m.sums.orbit.true_anomaly_rad, OrbitOf(m.definition).true_anomaly_rad.value_or(0.0)));
     },
     kOfTrueAnomaly},

    {"rail_exit_incidence", kDegrees, "α_rail", kFreeFlight, "Incidence off the rail",
     "total, to the air and its wind, where the vehicle leaves the rail", kLarger,
     [](const Measured& m) { return m.OffTheRail(m.sums.free.rail_exit_incidence_rad * kDegPerRad); },
     kOfRailSince3},

    {"propellant_left", kKilograms, "m_left", kInjection, "Propellant left",
     "usable, at the end of a burn that a command ends: without the residual, which grows with the mixture",
     kSmaller, [](const Measured& m) { return m.PropellantLeft(); }, kOfEachCutOff},
    {"depleted", kPure, "–", kInjection, "Depleted",
     "1 if the usable propellant ended the last burn that a command ends before the command did, else 0",
     kLarger,
     [](const Measured& m) {
       const double left_kg = m.PropellantLeft();
       return std::isnan(left_kg) ? kUndefined : left_kg > 0.0 ? 0.0 : 1.0;
     },
     kOfCutOff},
};

// Sums of all stages together. If several stages share a peak, the first stage has it.
ErrorSums Total(const ErrorSums (&stages)[kMaxStages]) {
  ErrorSums total;
  for (const ErrorSums& stage : stages) {
    total.squares += stage.squares;
    total.count += stage.count;
    if (stage.peak <= total.peak) continue;
    total.peak = stage.peak;
    total.peak_time_s = stage.peak_time_s;
  }
  return total;
}

// Phases: 0 all powered flight, then the stages, then the coast.
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

// Phases of stages that few vehicles have.
constexpr bool IsRare(int phase) { return phase > kUsualStages && phase <= kMaxStages; }

// f(row, phase) for each metric in the order of the columns: of rare stages behind all others.
template <class F>
void ForEach(F f) {
  const auto by_phase = [&](bool rare) {
    for (int phase = 0; phase < kPhases; ++phase)
      for (const Row& row : kRows)
        if (row.traits.by_stage && (phase < kPhases - 1 || row.traits.by_coast) && IsRare(phase) == rare)
          f(row, phase);
  };
  by_phase(false);
  for (const Row& row : kRows)
    if (!row.traits.by_stage) f(row, 0);
  by_phase(true);
}

// Errors against a reference and what is done about them are of controlled flights.
MetricNeeds NeedsOf(const Row& row) {
  const bool is_of_control = row.group == kAttitude || row.group == kControlEffort ||
                             row.group == kGuidance || row.group == kControlLaw;
  return is_of_control ? MetricNeeds::kControl : row.traits.needs;
}

bool Meets(const FlightKind& kind, MetricNeeds needs) {
  switch (needs) {
    case MetricNeeds::kNothing:
      return true;
    case MetricNeeds::kControl:
      return kind.is_controlled;
    case MetricNeeds::kFreeStage:
      return kind.has_free_stage;
    case MetricNeeds::kSectionLoads:
      return kind.has_section_loads;
    case MetricNeeds::kLimits:
      return kind.has_limits;
    case MetricNeeds::kRail:
      return kind.has_rail;
    case MetricNeeds::kCutOff:
      return kind.has_cut_off;
    case MetricNeeds::kApogee:
      return kind.ends != FlightEnd::kInjection;
    case MetricNeeds::kImpact:
      return kind.ends == FlightEnd::kImpact;
    case MetricNeeds::kNode:
      return kind.has_node;
    case MetricNeeds::kArgumentOfPerigee:
      return kind.has_argument_of_perigee;
    case MetricNeeds::kTrueAnomaly:
      return kind.has_true_anomaly;
  }
  return false;
}

const char* OverOf(const Row& row) {
  if (row.traits.over != nullptr) return row.traits.over;
  switch (row.group) {
    case kAttitude:
    case kControlEffort:
    case kControlLaw:
      return "burns of stages that an autopilot controls";
    case kLoads:
      return kLoaded;
    case kInjection:
      return "the end of the last burn";
    case kGuidance:
      return "the last plan";
    case kIntegration:
      return "before lift-off";
    default:
      break;
  }
  switch (row.traits.needs) {
    case MetricNeeds::kFreeStage:
      return "flight of stages without gimbal, to the apogee";
    case MetricNeeds::kRail:
      return "where it leaves the rail";
    case MetricNeeds::kApogee:
      return "the apogee";
    default:
      return "the impact";
  }
}

// The metrics of all stages.
std::vector<Metric> AllMetrics() {
  std::vector<Metric> list;
  ForEach([&](const Row& row, int phase) {
    const std::string stem = phase == 0 ? row.stem : std::string(row.stem) + "_" + PhaseName(phase);
    list.push_back({.name = stem + row.unit.suffix,
                    .title = row.title + PhaseTitle(phase),
                    .symbol = row.symbol,
                    .unit = row.unit.text,
                    .definition = row.definition,
                    .over = phase == 0             ? OverOf(row)
                            : phase == kPhases - 1 ? "coasts"
                                                   : "the burn of stage " + std::to_string(phase),
                    .group = row.group,
                    .worse = row.worse,
                    .is_usual = row.traits.is_usual && phase == 0,
                    .is_digested = row.traits.is_digested && !IsRare(phase),
                    .is_part = phase != 0,
                    .of_law = row.traits.of_law,
                    .needs = NeedsOf(row),
                    .circle = row.traits.circle,
                    .since = row.traits.since});
  });
  return list;
}

constexpr std::size_t kRareMetrics =
    (kMaxStages - kUsualStages) *
    static_cast<std::size_t>(std::count_if(std::begin(kRows), std::end(kRows),
                                           [](const Row& row) { return row.traits.by_stage; }));

}  // namespace

const std::vector<Metric>& Metrics() {
  static const std::vector<Metric> metrics = AllMetrics();
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

FlightKind KindOf(const Vehicle& vehicle, const AutopilotConfig& autopilot, const FlightCourse& course) {
  FlightKind kind(autopilot.pitch.law);
  kind.is_controlled = course.is_controlled;
  kind.has_free_stage = std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                                    [](const Stage& stage) { return !stage.is_controlled(); });
  kind.has_section_loads = HasSectionLoads(vehicle);
  kind.has_limits = HasLimits(vehicle.limits);
  kind.has_cut_off = std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                                 [](const Stage& stage) { return EndsByCommand(stage.motor); });
  kind.has_rail = vehicle.rail && vehicle.rail->length_m > 0.0;
  kind.ends = course.ends;
  return kind;
}

FlightKind AnyUnder(ControlLaw law) {
  FlightKind any(law);
  any.has_free_stage = any.has_section_loads = any.has_limits = any.has_rail = any.has_cut_off = true;
  any.ends = FlightEnd::kImpact;
  any.has_node = any.has_argument_of_perigee = any.has_true_anomaly = true;
  return any;
}

bool HasMetric(const Metric& metric, const FlightKind& kind) {
  return (metric.of_law == nullptr || InfoOf(kind.pitch_law).*metric.of_law) && Meets(kind, metric.needs);
}

std::string NeedsOf(const Metric& metric) {
  switch (metric.needs) {
    case MetricNeeds::kNothing:
      return "";
    case MetricNeeds::kControl:
      return "a stage that an autopilot controls";
    case MetricNeeds::kFreeStage:
      return "a stage without gimbal";
    case MetricNeeds::kSectionLoads:
      return "section loads: a profile, and of boosters their attachment_station";
    case MetricNeeds::kLimits:
      return "limits of the vehicle's structure";
    case MetricNeeds::kRail:
      return "a rail";
    case MetricNeeds::kCutOff:
      return "a burn with cut_off";
    case MetricNeeds::kApogee:
      return "flight: {ends: apogee} or {ends: impact}";
    case MetricNeeds::kImpact:
      return "flight: {ends: impact}";
    case MetricNeeds::kNode:
      return "a target that names a node";
    case MetricNeeds::kArgumentOfPerigee:
      return "a target that names an argument of perigee";
    case MetricNeeds::kTrueAnomaly:
      return "a target that names a true anomaly";
  }
  return "";
}

std::vector<std::size_t> MetricsUnder(std::size_t stages, const FlightKind& kind) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < MetricCount(stages); ++i)
    if (HasMetric(Metrics()[i], kind)) positions.push_back(i);
  return positions;
}

std::string LawsWith(const Metric& metric) {
  std::string names;
  for (const LawInfo& law : kLaws)
    if (metric.of_law == nullptr || law.*metric.of_law)
      names += (names.empty() ? "" : " or ") + std::string(law.name);
  return names;
}

std::size_t MetricColumn(const std::string& name) {
  const std::vector<std::string>& names = MetricNames();
  const auto found = std::find(names.begin(), names.end(), name);
  DISPERSA_ASSERT(found != names.end());
  return static_cast<std::size_t>(found - names.begin());
}

MeasuredFlight Measure(const FlightSums& sums, const FlightDefinition& definition) {
  const std::size_t count = MetricCount(ColumnClass(definition.vehicle));
  const LawInfo& law = InfoOf(definition.autopilot.pitch.law);
  FlightKind kind = KindOf(definition.vehicle, definition.autopilot, definition.course);
  const InjectionTarget& target = definition.target;
  kind.has_node = target.node_rad.has_value();
  kind.has_argument_of_perigee = target.orbit && target.orbit->argument_of_perigee_rad;
  kind.has_true_anomaly = target.orbit && target.orbit->true_anomaly_rad;
  MeasuredFlight measured;
  measured.metrics.reserve(MetricNames().size());
  measured.digested.reserve(MetricNames().size());
  ForEach([&](const Row& row, int phase) {
    const ErrorSums pitch = PitchOf(phase, sums);
    const double value = row.value({sums, definition, pitch, phase == kPhases - 1 ? -1 : phase - 1});
    const bool has = (row.traits.of_law == nullptr || law.*row.traits.of_law) && Meets(kind, NeedsOf(row));
    measured.metrics.push_back(has ? value : kUndefined);
    if (row.traits.is_digested && !IsRare(phase)) measured.digested.push_back(value);
  });
  measured.metrics.resize(count);
  return measured;
}

}  // namespace dispersa
