#include <cmath>
#include "core/campaign_yaml/attitude_columns.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"

#include "core/input/map_reader.h"
#include "core/environment/earth.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

constexpr Range kAzimuth = Between(0.0, kTwoPi);
constexpr Range kIncidence = {0.0, kPi / 2.0, false, true};

// "key_unit: [low, high]"; equal limits freeze the variable.
Bounds DecodeBounds(MapReader& map, const std::string& stem, Dimension dimension, const Range& range) {
  const std::vector<double> limits = map.Quantities(stem, dimension, range, 2, 2);
  if (limits.size() != 2) return {};
  if (limits[0] > limits[1]) {
    AddProblem(map.problems(), map.node(), map.PathOf(stem + "_" + std::string(dimension.front().suffix)),
               "the lower bound is above the upper one", "[low, high]");
  }
  return {limits[0], limits[1]};
}

// Of the launch azimuth: bounds that fall go through north, [350, 10] as [350, 370] does.
Bounds DecodeAzimuthBounds(MapReader& map) {
  const std::vector<double> limits =
      map.Quantities("launch_azimuth", kAngle, Between(0.0, 2.0 * kTwoPi), 2, 2);
  if (limits.size() != 2) return {};
  const Bounds bounds{limits[0], limits[0] <= limits[1] ? limits[1] : limits[1] + kTwoPi};
  if (limits[0] >= kTwoPi || bounds.high - bounds.low > kTwoPi)
    AddProblem(map.problems(), map.node(), map.PathOf("launch_azimuth_deg"), "is more than a turn",
               "[low, high], low from 0 to below 360; [350, 10] goes through north");
  return bounds;
}

std::string CoastStem(std::size_t stage) { return "stage" + std::to_string(stage + 1) + "_coast"; }
std::string IgnitionStem(std::size_t stage) { return "stage" + std::to_string(stage + 1) + "_ignition"; }

std::string SteeringStem(std::size_t stage, const char* when) {
  return "stage" + std::to_string(stage + 1) + "_incidence_" + when;
}
constexpr Range kSteered = Between(-kPi / 4.0, kPi / 4.0);

// The speed at the perigee of an ellipse about a point mass; altitudes over the equator's radius.
double PerigeeSpeed(double perigee_m, double apogee_m) {
  const Earth earth = Wgs84();
  const double perigee_radius_m = earth.equatorial_radius_m + perigee_m;
  const double axis_m = earth.equatorial_radius_m + 0.5 * (perigee_m + apogee_m);
  return std::sqrt(earth.mu_m3_s2 * (2.0 / perigee_radius_m - 1.0 / axis_m));
}

void DecodeTarget(const InputNode& node, const std::string& path, TrajectoryProblem& problem,
                  ProblemList& problems) {
  MapReader target(node, path, problems);
  problem.target_inclination_rad = target.OptionalQuantity("inclination", kAngle, Between(0.0, kPi));
  problem.target_node_rad = target.OptionalQuantity("node", kAngle, Between(0.0, kTwoPi));
  problem.target_argument_of_perigee_rad =
      target.OptionalQuantity("argument_of_perigee", kAngle, Between(0.0, kTwoPi));
  if (problem.target_argument_of_perigee_rad &&
      !(problem.target_inclination_rad && target.Has("perigee_altitude", kLength)))
    AddProblem(problems, node, path, "an argument of perigee counts along an ellipse from its node",
               "argument_of_perigee_deg beside perigee_altitude_km, apogee_altitude_km and inclination_deg");
  if (target.Has("perigee_altitude", kLength) || target.Has("apogee_altitude", kLength)) {
    problem.target_altitude_m = target.Quantity("perigee_altitude", kLength, kPositive);
    problem.target_apogee_m = target.Quantity("apogee_altitude", kLength, kPositive);
    if (problem.target_altitude_m > *problem.target_apogee_m)
      AddProblem(problems, node, path, "the perigee is above the apogee",
                 "perigee_altitude up to apogee_altitude");
    else
      problem.target_velocity_m_s = PerigeeSpeed(problem.target_altitude_m, *problem.target_apogee_m);
    return;
  }
  problem.target_altitude_m = target.Quantity("altitude", kLength, kPositive);
  const bool may_lack = problem.target_inclination_rad.has_value();
  problem.velocity_is_free = may_lack && !target.Has("velocity", kSpeed);
  if (!problem.velocity_is_free) problem.target_velocity_m_s = target.Quantity("velocity", kSpeed, kPositive);
  problem.target_flight_path_angle_rad =
      target.Quantity("flight_path_angle", kAngle, Inside(-kPi / 2.0, kPi / 2.0));
}

FlightProgram DecodeProgram(const InputNode& node, const std::string& path, double* last_ignition_s,
                            std::array<double, kMaxStages>* earlier_ignition_s, ProblemList& problems) {
  const std::size_t before = problems.size();
  MapReader map(node, path, problems);
  FlightProgram program;
  program.alpha_max_rad = map.Quantity("alpha_max", kAngle, kIncidence);
  program.t1_s = map.Quantity("t1", kTime, kNonNegative);
  program.t3_s = map.Quantity("t3", kTime, kNonNegative);
  program.t2_s = map.Quantity("t2", kTime, kNonNegative);
  program.coast_s = map.Quantity("coast", kTime, kNonNegative);
  program.launch_azimuth_rad = map.Quantity("launch_azimuth", kAngle, kAzimuth);
  *last_ignition_s = map.Quantity("last_ignition", kTime, kNonNegative);  // 0: a single stage's, at lift-off
  for (std::size_t stage = 1; stage < kMaxStages; ++stage) {
    if (map.Has(SteeringStem(stage, "begin"), kAngle) || map.Has(SteeringStem(stage, "end"), kAngle))
      program.steering[stage] = {map.Quantity(SteeringStem(stage, "begin"), kAngle, kSteered),
                                 map.Quantity(SteeringStem(stage, "end"), kAngle, kSteered)};
    if (!map.Has(CoastStem(stage), kTime) && !map.Has(IgnitionStem(stage), kTime)) continue;
    program.earlier_coast_s[stage] = map.Quantity(CoastStem(stage), kTime, kNonNegative);
    (*earlier_ignition_s)[stage] = map.Quantity(IgnitionStem(stage), kTime, kPositive);
  }
  if (node.file != nullptr && problems.size() == before &&
      !(program.t1_s < program.t3_s && program.t3_s < program.t2_s)) {
    AddProblem(problems, node, path, "the times are out of order", "t1 < t3 < t2");
  }
  return program;
}

Orbit DecodeOrbit(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Orbit orbit;
  orbit.altitude_m = map.Quantity("altitude", kLength, kAnyNumber);
  orbit.velocity_m_s = map.Quantity("velocity", kSpeed, kNonNegative);
  orbit.flight_path_angle_rad = map.Quantity("flight_path_angle", kAngle, kAnyNumber);
  orbit.inclination_rad = map.Quantity("inclination", kAngle, Between(0.0, kPi));
  orbit.node_longitude_rad = map.Quantity("node_longitude", kAngle, Between(0.0, kTwoPi), 0.0);
  orbit.argument_of_latitude_rad = map.Quantity("argument_of_latitude", kAngle, Between(0.0, kTwoPi), 0.0);
  return orbit;
}

// The errors follow from orbit and target; the file repeats them for its reader.
void CheckErrors(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  map.Quantity("altitude", kLength, kAnyNumber);
  map.Quantity("velocity", kSpeed, kAnyNumber);
  map.Quantity("flight_path_angle", kAngle, kAnyNumber);
  map.OptionalQuantity("inclination", kAngle, kAnyNumber);
  map.OptionalQuantity("argument_of_perigee", kAngle, kAnyNumber);
}

ConstraintMargin DecodeConstraint(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  ConstraintMargin constraint;
  constraint.name = map.Text("name");
  constraint.value = map.Number("value", kAnyNumber);
  constraint.limit = map.Number("limit", kAnyNumber);
  constraint.margin = map.Number("margin", kAnyNumber);
  constraint.enforced = map.Flag("enforced", true);
  return constraint;
}

void DecodeProvenance(const InputNode& node, const std::string& path, Reference& reference,
                      ProblemList& problems) {
  MapReader map(node, path, problems);
  reference.engine = map.Text("engine");
  reference.vehicle_sha256 = map.Text("vehicle_sha256");
  reference.evaluations = static_cast<std::int64_t>(map.Integer("evaluations", 0, INT64_MAX));
}

AttitudeProgram DecodeAttitude(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  AttitudeProgram attitude;
  const std::vector<std::string> columns = AttitudeColumnNames();
  map.Each("columns", columns.size(), columns.size(),
           [&](const InputNode& item, const std::string& item_path) {
             SayExpects(item_path, {.kind = Expectation::Kind::kWords, .words = columns});
             const std::string& expected =
                 columns[static_cast<std::size_t>(&item - node.Find("columns")->items.data())];
             if (item.text != expected) {
               AddProblem(problems, item, item_path, item.Describe() + " is not the column", expected);
             }
           });
  map.Each("rows", 2, SIZE_MAX, [&](const InputNode& row, const std::string& row_path) {
    SayExpects(row_path,
               {.kind = Expectation::Kind::kList, .low_count = columns.size(), .high_count = columns.size()});
    SayExpects(row_path + "[]", {.kind = Expectation::Kind::kNumber});
    if (row.kind != InputNode::Kind::kList || row.items.size() != columns.size()) {
      AddProblem(problems, row, row_path, row.Describe() + " is not a row",
                 "a list of " + std::to_string(columns.size()) + " numbers: " + JoinWords(columns));
      return;
    }
    AttitudeKnot knot;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      knot.*kAttitudeColumns[c].field = ReadNumber(row.items[c], row_path + "[" + std::to_string(c) + "]",
                                                   problems, kAnyNumber, kAttitudeColumns[c].scale);
    }
    if (!attitude.knots.empty() && knot.time_s <= attitude.knots.back().time_s) {
      AddProblem(problems, row.items[0], row_path + "[0]", "the time is not after the row before",
                 "strictly increasing times");
    }
    attitude.knots.push_back(knot);
  });
  return attitude;
}

}  // namespace

TrajectoryProblem DecodeTrajectoryProblem(const InputNode& node, const std::string& path,
                                          std::vector<InputProblem>& problems) {
  TrajectoryProblem problem;
  MapReader map(node, path, problems);
  DecodeTarget(map.Required("target", "a map"), map.PathOf("target"), problem, problems);
  {
    MapReader bounds(map.Required("bounds", "a map"), map.PathOf("bounds"), problems);
    problem.alpha_max_rad = DecodeBounds(bounds, "alpha_max", kAngle, kIncidence);
    problem.t1_s = DecodeBounds(bounds, "t1", kTime, kNonNegative);
    problem.t3_s = DecodeBounds(bounds, "t3", kTime, kNonNegative);
    problem.t2_s = DecodeBounds(bounds, "t2", kTime, kNonNegative);
    problem.coast_s = DecodeBounds(bounds, "coast", kTime, kNonNegative);
    problem.launch_azimuth_rad = DecodeAzimuthBounds(bounds);
    for (std::size_t stage = 1; stage < kMaxStages; ++stage) {
      if (bounds.Has(CoastStem(stage), kTime))
        problem.earlier_coast_s[stage] = DecodeBounds(bounds, CoastStem(stage), kTime, kNonNegative);
      if (bounds.Has(SteeringStem(stage, "begin"), kAngle) || bounds.Has(SteeringStem(stage, "end"), kAngle))
        problem.steering[stage] = {DecodeBounds(bounds, SteeringStem(stage, "begin"), kAngle, kSteered),
                                   DecodeBounds(bounds, SteeringStem(stage, "end"), kAngle, kSteered)};
    }
  }
  {
    MapReader weights(map.Required("weights", "a map"), map.PathOf("weights"), problems);
    problem.weight_altitude_1_m = weights.Quantity("altitude", kPerLength, kNonNegative);
    problem.weight_velocity_s_m = weights.Quantity("velocity", kPerSpeed, kNonNegative);
    problem.weight_angle_1_rad = weights.Quantity("flight_path_angle", kPerAngle, kNonNegative);
    if (problem.target_inclination_rad)
      problem.weight_inclination_1_rad = weights.Quantity("inclination", kPerAngle, kNonNegative);
    if (problem.target_argument_of_perigee_rad)
      problem.weight_argument_1_rad = weights.Quantity("argument_of_perigee", kPerAngle, kNonNegative);
  }
  {
    MapReader limits(map.Required("limits", "a map"), map.PathOf("limits"), problems);
    problem.axial_load_limit_g = limits.Quantity("axial_load", kAcceleration, kPositive);
    problem.lateral_load_limit_g = limits.Quantity("lateral_load", kAcceleration, kPositive);
    problem.alpha_limit_rad = limits.Quantity("alpha", kAngle, {0.0, kPi / 2.0, true, true});
    problem.turn_rate_limit_rad_s = limits.Quantity("turn_rate", kAngularRate, kPositive, 0.0);
    problem.transonic_mach_low = limits.Number("transonic_mach_low", kPositive);
    problem.transonic_mach_high = limits.Number("transonic_mach_high", kPositive);
    problem.q_max_limit_pa = limits.Quantity("q_max", kPressure, kPositive, 0.0);
    problem.q_alpha_limit_pa_rad = limits.Quantity("q_alpha", kPressureAngle, kPositive, 0.0);
  }
  problem.velocity_reserve_m_s = map.Quantity("velocity_reserve", kSpeed, Between(0.0, 1000.0), 0.0);
  problem.reaction_control_propellant_kg =
      map.Quantity("reaction_control_propellant", kMass, kNonNegative, 0.0);
  problem.population = static_cast<int>(map.Integer("population", 4, 65535));
  problem.generations = static_cast<int>(map.Integer("generations", 1, 65535));
  problem.seed = map.Integer("seed", 0, UINT64_MAX);
  return problem;
}

Reference DecodeReference(const InputNode& node, const std::string& path,
                          std::vector<InputProblem>& problems) {
  Reference reference;
  if (!CheckSchema(node, kReferenceSchema, !path.empty(), path, problems)) return reference;
  MapReader map(node, path, problems);
  map.Allow("schema");
  reference.name = map.Text("name");
  reference.target_missed = map.Text("target_missed", "");
  reference.problem =
      DecodeTrajectoryProblem(map.Required("problem", "a map"), map.PathOf("problem"), problems);
  reference.program = DecodeProgram(map.Required("flight_program", "a map"), map.PathOf("flight_program"),
                                    &reference.last_ignition_s, &reference.earlier_ignition_s, problems);
  reference.orbit = DecodeOrbit(map.Required("orbit", "a map"), map.PathOf("orbit"), problems);
  CheckErrors(map.Required("errors", "a map"), map.PathOf("errors"), problems);
  map.Each("constraints", 0, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
    reference.constraints.push_back(DecodeConstraint(item, item_path, problems));
  });
  DecodeProvenance(map.Required("provenance", "a map"), map.PathOf("provenance"), reference, problems);
  reference.attitude = DecodeAttitude(map.Required("attitude", "a map"), map.PathOf("attitude"), problems);
  reference.attitude.launch_azimuth_rad = reference.program.launch_azimuth_rad;
  return reference;
}

}  // namespace dispersa
