#include <cmath>

#include "core/environment/earth.h"
#include "core/input/number_text.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/optimize.h"
#include "core/trajectory/reference.h"

namespace dispersa {
namespace {

constexpr Range kAzimuth = Between(0.0, kTwoPi);
constexpr Range kIncidence = {0.0, kPi / 2.0, false, true};
constexpr Range kSteered = Between(-kPi / 4.0, kPi / 4.0);

std::string StageKey(std::size_t stage, const char* what) {
  return "stage" + std::to_string(stage + 1) + "_" + what;
}

// The two bounds of a decision variable, a list in the file.
void DescribeBounds(Fields& fields, const std::string& stem, Dimension dimension, const Range& range,
                    Bounds& bounds, const char* meaning, bool needed = true) {
  std::vector<double> limits;
  if (needed || bounds.high > 0.0) limits = {bounds.low, bounds.high};
  if (needed)
    fields.Quantities(stem.c_str(), dimension, range, 2, 2, limits, meaning);
  else
    fields.OptionalQuantities(stem.c_str(), dimension, range, 2, 2, limits, meaning);
  if (limits.size() != 2) return;
  bounds = {limits[0], limits[1]};
  if (limits[0] > limits[1]) fields.Refuse(stem, "the lower bound is above the upper one", "[low, high]");
}

// Descending bounds go through north: [350, 10] equals [350, 370].
void DescribeAzimuthBounds(Fields& fields, Bounds& bounds) {
  std::vector<double> limits = {bounds.low, bounds.high};
  fields.Quantities("launch_azimuth", kAngle, Between(0.0, 2.0 * kTwoPi), 2, 2, limits,
                    "[low, high], clockwise from north; [350, 10] goes through north");
  if (limits.size() != 2) return;
  bounds = {limits[0], limits[0] <= limits[1] ? limits[1] : limits[1] + kTwoPi};
  if (limits[0] > limits[1] && bounds.high - bounds.low > kPi)
    return fields.Refuse("launch_azimuth",
                         "descends, and so goes through north, over " +
                             FormatRounded((bounds.high - bounds.low) * kDegPerRad) + " deg",
                         "[low, high]; through north at most half a turn, as [350, 10]");
  if (limits[0] >= kTwoPi || bounds.high - bounds.low > kTwoPi)
    fields.Refuse("launch_azimuth", "is more than a turn",
                  "[low, high], low from 0 to below 360; [350, 10] goes through north");
}

// The speed (m/s) at the perigee of an ellipse about a point mass. Altitudes are above the equator's radius.
double PerigeeSpeed(double perigee_m, double apogee_m) {
  const Earth earth = Wgs84();
  const double perigee_radius_m = earth.equatorial_radius_m + perigee_m;
  const double axis_m = earth.equatorial_radius_m + 0.5 * (perigee_m + apogee_m);
  return std::sqrt(earth.mu_m3_s2 * (2.0 / perigee_radius_m - 1.0 / axis_m));
}

// Where an ellipse is entered. Then its speed and flight path angle are known.
void DescribeEntry(Fields& fields, TrajectoryProblem& problem) {
  fields.Either(
      {{Has("true_anomaly", kAngle),
        [&] {
          fields.OptionalQuantity("true_anomaly", kAngle, Between(-kPi, kTwoPi),
                                  problem.target_true_anomaly_rad, "of the injection");
          fields.Misplaced("entered_at", {}, "'entered_at' and 'true_anomaly' are both given", "one of them");
        },
        problem.target_true_anomaly_rad.has_value()},
       {Else(), [&] {
          fields.Choice<bool>("entered_at", {{"perigee", false}, {"anywhere", true}},
                              problem.is_entered_anywhere, "true anomaly of the injection: 0, or any", false);
        }}});
  problem.target_velocity_m_s = PerigeeSpeed(problem.target_altitude_m, *problem.target_apogee_m);
  if (problem.target_true_anomaly_rad) {
    const AimedPlace place = PlaceAimedAt(problem);
    problem.target_velocity_m_s = place.velocity_m_s;
    problem.target_flight_path_angle_rad = place.flight_path_angle_rad;
  }
}

void DescribeApsides(Fields& fields, TrajectoryProblem& problem) {
  if (!problem.target_apogee_m) problem.target_apogee_m.emplace();
  double& apogee_m = *problem.target_apogee_m;
  fields.Quantity("perigee_altitude", kLength, kPositive, problem.target_altitude_m,
                  "of an ellipse; above the equator's radius");
  fields.Quantity("apogee_altitude", kLength, kPositive, apogee_m, "apogee of the same ellipse");
  if (problem.target_altitude_m > apogee_m) {
    fields.Refuse("", "the perigee is above the apogee", "perigee_altitude up to apogee_altitude");
    apogee_m = problem.target_altitude_m;
  }
  DescribeEntry(fields, problem);
}

void DescribeAxis(Fields& fields, TrajectoryProblem& problem) {
  problem.is_given_by_axis = true;
  const Earth earth = Wgs84();
  double &axis_m = problem.target_semi_major_axis_m, &eccentricity = problem.target_eccentricity;
  fields.Quantity("semi_major_axis", kLength, kPositive, axis_m, "of an ellipse, in place of its apsides");
  fields.Number("eccentricity", {0.0, 1.0, false, true}, eccentricity, "of the same ellipse");
  problem.target_altitude_m = axis_m * (1.0 - eccentricity) - earth.equatorial_radius_m;
  problem.target_apogee_m = axis_m * (1.0 + eccentricity) - earth.equatorial_radius_m;
  if (axis_m > 0.0 && !(problem.target_altitude_m > 0.0)) {
    fields.Refuse("", "the perigee is below the equator's radius",
                  "semi_major_axis times (1 - eccentricity) above 6378.137 km");
    problem.target_altitude_m = 1.0;
    problem.target_apogee_m = 1.0;
  }
  DescribeEntry(fields, problem);
}

void DescribeInjection(Fields& fields, TrajectoryProblem& problem) {
  fields.Quantity("altitude", kLength, kPositive, problem.target_altitude_m, "geodetic, at injection");
  const auto velocity = [&] {
    fields.Quantity("velocity", kSpeed, kPositive, problem.target_velocity_m_s,
                    "inertial; a target with an inclination need not give it");
  };
  fields.Either(
      {{Has("velocity", kSpeed), velocity, !problem.velocity_is_free},
       {Has("inclination", kAngle), [&] { problem.velocity_is_free = true; }, problem.velocity_is_free},
       {Else(), velocity}});
  fields.Quantity("flight_path_angle", kAngle, Inside(-kPi / 2.0, kPi / 2.0),
                  problem.target_flight_path_angle_rad, "inertial");
}

void DescribeTarget(Fields& fields, TrajectoryProblem& problem) {
  const auto apsides = [&] { DescribeApsides(fields, problem); };
  fields.Either(
      {{Has("perigee_altitude", kLength), apsides,
        problem.target_apogee_m.has_value() && !problem.is_given_by_axis},
       {Has("apogee_altitude", kLength), apsides},
       {Has("semi_major_axis", kLength), [&] { DescribeAxis(fields, problem); }, problem.is_given_by_axis},
       {Else(), [&] { DescribeInjection(fields, problem); }}});
  fields.OptionalQuantity("inclination", kAngle, Between(0.0, kPi), problem.target_inclination_rad,
                          "of the orbit");
  fields.OptionalQuantity("node", kAngle, Between(0.0, kTwoPi), problem.target_node_rad,
                          "right ascension; it sets the time of day of the lift-off");
  fields.OptionalQuantity("argument_of_perigee", kAngle, Between(0.0, kTwoPi),
                          problem.target_argument_of_perigee_rad, "of an ellipse");
  if (problem.target_argument_of_perigee_rad && !problem.target_apogee_m)
    fields.Refuse("", "an argument of perigee counts along an ellipse from its node",
                  "argument_of_perigee_deg beside perigee_altitude_km and apogee_altitude_km");
  // A circle has no perigee, but a place on it has an angle from the node: the sum of both.
  const bool is_circle = problem.target_apogee_m && *problem.target_apogee_m == problem.target_altitude_m;
  const bool has_argument = problem.target_argument_of_perigee_rad.has_value();
  if (is_circle &&
      ((problem.target_true_anomaly_rad && !has_argument) || (has_argument && problem.is_entered_anywhere)))
    fields.Refuse("", "a circle has no perigee from which an angle could count",
                  "argument_of_perigee_deg and true_anomaly_deg, whose sum is the argument of latitude, or "
                  "neither");
}

// The keys of a stage that steers. They are given together.
void DescribeSteering(Fields& fields, std::size_t stage, bool steers,
                      const std::function<void(const std::string& begin, const std::string& end)>& describe) {
  const std::string begin = StageKey(stage, "incidence_begin"), end = StageKey(stage, "incidence_end");
  const auto both = [&] { describe(begin, end); };
  fields.Either({{Has(begin, kAngle), both, steers}, {Has(end, kAngle), both}});
}

void DescribeDecisionBounds(Fields& fields, TrajectoryProblem& problem) {
  DescribeBounds(fields, "alpha_max", kAngle, kIncidence, problem.alpha_max_rad,
                 "[low, high] of the largest incidence, nose down; equal: fixed");
  DescribeBounds(fields, "t1", kTime, kNonNegative, problem.t1_s,
                 "[low, high] of the end of the vertical ascent");
  DescribeBounds(fields, "t3", kTime, kNonNegative, problem.t3_s,
                 "[low, high] of the time of the largest incidence");
  DescribeBounds(fields, "t2", kTime, kNonNegative, problem.t2_s,
                 "[low, high] of the start of the gravity turn");
  DescribeBounds(fields, "coast", kTime, kNonNegative, problem.coast_s,
                 "[low, high] of the coast before the last stage ignites");
  DescribeAzimuthBounds(fields, problem.launch_azimuth_rad);
  for (std::size_t stage = 1; stage < kMaxStages; ++stage)
    DescribeBounds(fields, StageKey(stage, "coast"), kTime, kNonNegative, problem.earlier_coast_s[stage],
                   "[low, high] of the coast before this stage, ignited by a timer", false);
  for (std::size_t stage = 0; stage < kMaxStages; ++stage) {
    auto& steering = problem.steering[stage];
    DescribeSteering(fields, stage, !steering.empty(), [&](const std::string& begin, const std::string& end) {
      DescribeBounds(fields, begin, kAngle, kSteered, steering.begin_rad,
                     stage == 0 ? "[low, high] of the incidence when the boosters leave"
                                : "[low, high] of this stage's incidence in the plane of ascent at ignition");
      DescribeBounds(fields, end, kAngle, kSteered, steering.end_rad,
                     "[low, high] of it when the propellant would be used up");
    });
  }
}

// The weights of objective (8). A target with more conditions has more weights.
void DescribeWeights(Fields& fields, TrajectoryProblem& problem, bool of_inclination, bool of_argument) {
  fields.Map("weights", "of the target errors in the objective, equation (8)", [&](Fields& weights) {
    weights.Quantity("altitude", kPerLength, kNonNegative, problem.weight_altitude_1_m, "G1 of (8)");
    weights.Quantity("velocity", kPerSpeed, kNonNegative, problem.weight_velocity_s_m, "G2 of (8)");
    weights.Quantity("flight_path_angle", kPerAngle, kNonNegative, problem.weight_angle_1_rad, "G3 of (8)");
    if (of_argument)
      weights.Quantity("inclination", kPerAngle, kNonNegative, problem.weight_inclination_1_rad,
                       "of a target with an inclination", 0.0);
    else if (of_inclination)
      weights.Quantity("inclination", kPerAngle, kNonNegative, problem.weight_inclination_1_rad,
                       "of a target with an inclination");
    if (of_argument)
      weights.Quantity("argument_of_perigee", kPerAngle, kNonNegative, problem.weight_argument_1_rad,
                       "of a target with an argument of perigee");
  });
}

void DescribeConstraints(Fields& fields, TrajectoryProblem& problem) {
  fields.Quantity("axial_load", kAcceleration, kPositive, problem.axial_load_limit_g, "largest");
  fields.Quantity("lateral_load", kAcceleration, kPositive, problem.lateral_load_limit_g, "largest");
  fields.Quantity("alpha", kAngle, {0.0, kPi / 2.0, true, true}, problem.alpha_limit_rad,
                  "largest incidence");
  fields.Quantity("turn_rate", kAngularRate, kPositive, problem.turn_rate_limit_rad_s,
                  "of the body axis in the pitch-over; default: only reported", 0.0);
  fields.Number("transonic_mach_low", kPositive, problem.transonic_mach_low,
                "zero incidence from this Mach number");
  fields.Number("transonic_mach_high", kPositive, problem.transonic_mach_high, "to this one");
  fields.Quantity("q_max", kPressure, kPositive, problem.q_max_limit_pa, "largest; default: only reported",
                  0.0);
  fields.Quantity("q_alpha", kPressureAngle, kPositive, problem.q_alpha_limit_pa_rad,
                  "largest; default: only reported", 0.0);
}

void DescribeProgram(Fields& fields, Reference& reference) {
  FlightProgram& program = reference.program;
  fields.Quantity("alpha_max", kAngle, kIncidence, program.alpha_max_rad, "largest incidence, nose down");
  fields.Quantity("t1", kTime, kNonNegative, program.t1_s, "end of the vertical ascent");
  fields.Quantity("t3", kTime, kNonNegative, program.t3_s, "of the largest incidence");
  fields.Quantity("t2", kTime, kNonNegative, program.t2_s, "start of the gravity turn");
  fields.Quantity("coast", kTime, kNonNegative, program.coast_s, "before the last stage ignites");
  fields.Quantity("launch_azimuth", kAngle, kAzimuth, program.launch_azimuth_rad, "clockwise from north");
  fields.Quantity("last_ignition", kTime, kNonNegative, reference.last_ignition_s,
                  "timer of the last stage, since lift-off; 0: a single stage");
  for (std::size_t stage = 1; stage < kMaxStages; ++stage) {
    const std::string coast = StageKey(stage, "coast"), ignition = StageKey(stage, "ignition");
    double& ignition_s = reference.earlier_ignition_s[stage];
    const auto timer = [&] {
      fields.Quantity(coast.c_str(), kTime, kNonNegative, program.earlier_coast_s[stage],
                      "before this stage, ignited by a timer");
      fields.Quantity(ignition.c_str(), kTime, kPositive, ignition_s, "the ignition timer, since lift-off");
    };
    fields.Either({{Has(coast, kTime), timer, ignition_s > 0.0}, {Has(ignition, kTime), timer}});
  }
  for (std::size_t stage = 0; stage < kMaxStages; ++stage) {
    auto& steering = program.steering[stage];
    DescribeSteering(fields, stage, !steering.empty(), [&](const std::string& begin, const std::string& end) {
      fields.Quantity(begin.c_str(), kAngle, kSteered, steering.begin_rad,
                      stage == 0 ? "incidence in the plane of ascent when the boosters leave"
                                 : "this stage's incidence in the plane of ascent at ignition");
      fields.Quantity(end.c_str(), kAngle, kSteered, steering.end_rad,
                      "its incidence when the propellant would be used up");
    });
  }
  fields.Check([&fields, &program] {
    if (!(program.t1_s < program.t3_s && program.t3_s < program.t2_s))
      fields.Refuse("", "the times are out of order", "t1 < t3 < t2");
  });
}

void DescribeOrbit(Fields& fields, Orbit& orbit) {
  fields.Quantity("altitude", kLength, kAnyNumber, orbit.altitude_m, "geodetic, at injection");
  fields.Quantity("velocity", kSpeed, kNonNegative, orbit.velocity_m_s, "inertial");
  fields.Quantity("flight_path_angle", kAngle, kAnyNumber, orbit.flight_path_angle_rad, "inertial");
  fields.Quantity("inclination", kAngle, Between(0.0, kPi), orbit.inclination_rad, "of the orbit");
  fields.Quantity("node_longitude", kAngle, Between(0.0, kTwoPi), orbit.node_longitude_rad,
                  "of the ascending node, east of Greenwich at lift-off", 0.0);
  fields.Quantity("argument_of_latitude", kAngle, Between(0.0, kTwoPi), orbit.argument_of_latitude_rad,
                  "from the node along the orbit", 0.0);
}

// The errors follow from orbit and target. The file repeats them for the reader.
void DescribeErrors(Fields& fields, const Reference& reference) {
  const TrajectoryProblem& problem = reference.problem;
  OrbitErrors errors = ErrorsOf(problem, reference.orbit);
  std::optional<double> inclination_rad, argument_rad;
  if (problem.target_inclination_rad) inclination_rad = errors.inclination_rad;
  if (problem.target_argument_of_perigee_rad) argument_rad = errors.argument_of_perigee_rad;
  constexpr const char* kMeaning = "orbit - target";
  fields.Quantity("altitude", kLength, kAnyNumber, errors.altitude_m, kMeaning);
  fields.Quantity("velocity", kSpeed, kAnyNumber, errors.velocity_m_s, kMeaning);
  fields.Quantity("flight_path_angle", kAngle, kAnyNumber, errors.flight_path_angle_rad, kMeaning);
  fields.OptionalQuantity("inclination", kAngle, kAnyNumber, inclination_rad, kMeaning);
  fields.OptionalQuantity("argument_of_perigee", kAngle, kAnyNumber, argument_rad, kMeaning);
}

void DescribeConstraint(Fields& fields, ConstraintMargin& constraint) {
  fields.Name("name", {}, "a constraint", constraint.name, "the limited quantity, with its unit");
  fields.Number("value", kAnyNumber, constraint.value, "of the trajectory");
  fields.Number("limit", kAnyNumber, constraint.limit, "of the problem");
  fields.Number("margin", kAnyNumber, constraint.margin, "limit - value");
  fields.Flag("enforced", constraint.enforced, true, "false: reported only");
}

void DescribeProvenance(Fields& fields, Reference& reference) {
  fields.Text("engine", reference.engine, "version of the engine");
  fields.Text("vehicle_sha256", reference.vehicle_sha256, "of the canonical vehicle");
  fields.Integer("evaluations", 0, INT64_MAX, reference.evaluations, "number of trajectories flown");
}

struct AttitudeColumn {
  const char* name;
  double AttitudeKnot::*field;
  double scale;  ///< value inside = value in the file * scale
};
constexpr AttitudeColumn kAttitudeColumns[] = {
    {"time_s", &AttitudeKnot::time_s, 1.0},
    {"pitch_deg", &AttitudeKnot::pitch, kRadPerDeg},
    {"yaw_deg", &AttitudeKnot::yaw, kRadPerDeg},
    {"roll_deg", &AttitudeKnot::roll, kRadPerDeg},
    {"pitch_rate_deg_s", &AttitudeKnot::pitch_rate, kRadPerDeg},
    {"yaw_rate_deg_s", &AttitudeKnot::yaw_rate, kRadPerDeg},
    {"roll_rate_deg_s", &AttitudeKnot::roll_rate, kRadPerDeg},
};

void DescribeAttitude(Fields& fields, AttitudeProgram& attitude) {
  std::vector<RowsKey::Column> columns;
  for (const AttitudeColumn& column : kAttitudeColumns) columns.push_back({column.name, column.scale});
  std::vector<std::vector<double>> rows;
  for (const AttitudeKnot& knot : attitude.knots) {
    std::vector<double>& row = rows.emplace_back();
    for (const AttitudeColumn& column : kAttitudeColumns) row.push_back(knot.*column.field);
  }
  fields.ColumnsAndRows(std::move(columns), 2, rows, "attitude in the launch-inertial frame");
  attitude.knots.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].empty()) continue;  // refused
    AttitudeKnot knot;
    for (std::size_t c = 0; c < rows[i].size(); ++c) knot.*kAttitudeColumns[c].field = rows[i][c];
    if (!attitude.knots.empty() && knot.time_s <= attitude.knots.back().time_s)
      fields.Refuse("rows[" + std::to_string(i) + "][0]", "the time is not after the row before",
                    "strictly increasing times");
    attitude.knots.push_back(knot);
  }
}

void DescribeProblem(Fields& fields, TrajectoryProblem& problem) {
  fields.Map("target", "the orbit", [&](Fields& target) { DescribeTarget(target, problem); });
  fields.Map("bounds", "of the decision variables",
             [&](Fields& bounds) { DescribeDecisionBounds(bounds, problem); });
  fields.Either(
      {{Has("target.argument_of_perigee", kAngle), [&] { DescribeWeights(fields, problem, true, true); },
        problem.target_argument_of_perigee_rad.has_value()},
       {Has("target.inclination", kAngle), [&] { DescribeWeights(fields, problem, true, false); },
        problem.target_inclination_rad.has_value()},
       {Else(), [&] { DescribeWeights(fields, problem, false, false); }}});
  fields.Map("limits", "constraints", [&](Fields& limits) { DescribeConstraints(limits, problem); });
  fields.Quantity("velocity_reserve", kSpeed, Between(0.0, 1000.0), problem.velocity_reserve_m_s,
                  "extra velocity of the trajectory, for guidance to use", 0.0);
  fields.Quantity("reaction_control_propellant", kMass, kNonNegative, problem.reaction_control_propellant_kg,
                  "expelled in flight before the last stage burns", 0.0);
  fields.Integer("population", 4, 65535, problem.population, "of the genetic algorithm");
  fields.Integer("generations", 1, 65535, problem.generations, "of the genetic algorithm");
  fields.Integer("seed", 0, UINT64_MAX, problem.seed, "of the genetic algorithm's draws");
}

}  // namespace

void Describe(Fields& fields, TrajectoryProblem& problem) {
  fields.Group("trajectory_problem", "launch", [&](Fields& group) { DescribeProblem(group, problem); });
}

void Describe(Fields& fields, Reference& reference) {
  fields.Text("name", reference.name, "of the reference");
  fields.Text("target_missed", reference.target_missed, "how near the search came to a missed target", "");
  fields.Map("problem", "the solved problem", [&](Fields& problem) { Describe(problem, reference.problem); });
  fields.Map("flight_program", "the result; times since lift-off",
             [&](Fields& program) { DescribeProgram(program, reference); });
  fields.Map("orbit", "reached, by the optimiser's own simulation",
             [&](Fields& orbit) { DescribeOrbit(orbit, reference.orbit); });
  fields.Check([&] {
    if (reference.problem.target_node_rad && reference.orbit.node_longitude_rad == 0.0)
      fields.Refuse("orbit", "has no node_longitude_deg, but the problem's target names a node",
                    "a reference that `dispersa optimize` wrote for this problem");
  });
  fields.Map("errors", "of that orbit", [&](Fields& errors) { DescribeErrors(errors, reference); });
  fields.List("constraints", 0, SIZE_MAX, reference.constraints, "values and margins", DescribeConstraint);
  fields.Map("provenance", "of the search",
             [&](Fields& provenance) { DescribeProvenance(provenance, reference); });
  fields.Map("attitude", "over the flight",
             [&](Fields& attitude) { DescribeAttitude(attitude, reference.attitude); });
  reference.attitude.launch_azimuth_rad = reference.program.launch_azimuth_rad;
}

}  // namespace dispersa
