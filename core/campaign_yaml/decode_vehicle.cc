#include <algorithm>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_beam.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/struct_problems.h"
#include "core/campaign_yaml/yaml_reader.h"
#include "core/vehicle/plausibility.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {
namespace {


using ProblemList = std::vector<InputProblem>;

LaunchSite DecodeSite(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  LaunchSite site;
  site.latitude_rad = map.Quantity("latitude", kAngle, Between(-kQuarterTurn, kQuarterTurn));
  site.longitude_rad = map.Quantity("longitude", kAngle, Between(-kHalfTurn, kHalfTurn));
  site.altitude_m = map.Quantity("altitude", kLength, Between(-500.0, 9000.0));
  return site;
}

// Times, thrusts and flows, if there are any, of a curve, each problem at its own line of the table.
ThrustCurve DecodeCurveTable(const InputNode& node, const std::string& path, ProblemList& problems) {
  ThrustCurve curve;
  const std::size_t before = problems.size();
  std::string time_key, thrust_key, flow_key;
  {
    MapReader map(node, path, problems);
    curve.time_s = map.Quantities("time", kTime, kNonNegative, 2, kThrustCurveCorners, &time_key);
    curve.thrust_n = map.Quantities("thrust", kForce, kNonNegative, 2, kThrustCurveCorners, &thrust_key);
    if (map.Has("mass_flow", kMassFlow))
      curve.flow_kg_s = map.Quantities("mass_flow", kMassFlow, kNonNegative, 2, kThrustCurveCorners, &flow_key);
    else
      map.IgnoreQuantity("mass_flow", kMassFlow);
  }
  if (node.file == nullptr || problems.size() > before) return {};
  const auto path_of = [&](const std::string& key, std::size_t i) {
    return (path.empty() ? key : path + "." + key) + "[" + std::to_string(i) + "]";
  };
  const std::vector<InputNode>& times = node.Find(time_key)->items;
  if (curve.time_s.size() != curve.thrust_n.size()) {
    AddProblem(problems, node, path,
               "there are " + std::to_string(curve.time_s.size()) + " times and " +
                   std::to_string(curve.thrust_n.size()) + " thrusts",
               "one thrust for each time");
    return {};
  }
  if (!flow_key.empty() && curve.flow_kg_s.size() != curve.time_s.size()) {
    AddProblem(problems, node, path,
               "there are " + std::to_string(curve.time_s.size()) + " times and " +
                   std::to_string(curve.flow_kg_s.size()) + " mass flows",
               "one mass flow for each time, or none at all");
    return {};
  }
  if (curve.time_s[0] != 0.0)
    AddProblem(problems, times[0], path_of(time_key, 0), times[0].Describe() + " is not the time of ignition",
               "0 as the first time");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(curve.time_s[i] > curve.time_s[i - 1]))
      AddProblem(problems, times[i], path_of(time_key, i),
                 times[i].Describe() + " is not later than " + times[i - 1].Describe() + " before it",
                 "times that increase");
  if (curve.Greatest() == 0.0)
    AddProblem(problems, *node.Find(thrust_key), path.empty() ? thrust_key : path + "." + thrust_key,
               "the thrust is 0 at all times", "a thrust above 0 somewhere");
  if (!flow_key.empty() && curve.Flown() == 0.0)
    AddProblem(problems, *node.Find(flow_key), path.empty() ? flow_key : path + "." + flow_key,
               "the mass flow is 0 at all times", "a mass flow above 0 somewhere");
  return problems.size() > before ? ThrustCurve{} : curve;
}

// In vacuum. Empty after a problem.
ThrustCurve DecodeThrustCurve(const InputNode& node, const std::string& path, double exit_area_m2,
                              ProblemList& problems) {
  MapReader map(node, path, problems);
  const bool is_in_vacuum = map.Choice<bool>("reference", {{"vacuum", true}, {"sea_level", false}});
  const InputNode& table =
      map.Required("table", "a CSV file (time_s, thrust_n, optional mass_flow_kg_s), an .eng file, or the columns");
  const ThrustCurve curve =
      DecodeCurveTable(table, table.file == node.file ? map.PathOf("table") : "", problems);
  if (is_in_vacuum) return curve;
  if (exit_area_m2 == 0.0)
    AddProblem(
        problems, *node.Find("reference"), map.PathOf("reference"),
        "the thrust in vacuum is that at sea level and p A_e, but the motor has no nozzle_exit_area_m2",
        "nozzle_exit_area_m2 above 0, or reference: vacuum");
  return InVacuum(curve, exit_area_m2);
}

// Times and levels, each problem at its own line of the table. What is wrong among them Problems() says.
Throttle DecodeThrottle(const InputNode& node, const std::string& path, ProblemList& problems) {
  Throttle throttle;
  const std::size_t before = problems.size();
  std::string time_key;
  {
    MapReader map(node, path, problems);
    throttle.time_s = map.Quantities("time", kTime, kNonNegative, 2, kThrustCurveCorners, &time_key);
    throttle.level = map.Quantities("level", kShare, Between(0.0, 1.0), 2, kThrustCurveCorners);
  }
  if (node.file == nullptr || problems.size() > before) return {};
  if (throttle.time_s.size() != throttle.level.size())
    AddProblem(problems, node, path,
               "there are " + std::to_string(throttle.time_s.size()) + " times and " +
                   std::to_string(throttle.level.size()) + " levels",
               "one level for each time");
  CheckIncreasing(node, path, time_key, throttle.time_s, problems);
  return throttle;
}

void DecodeCutOff(const InputNode& node, const std::string& path, Motor& motor, ProblemList& problems) {
  MapReader cut(node, path, problems);
  motor.cut_off = cut.Choice<CutOff>("at", {{"depletion", CutOff::kAtDepletion},
                                            {"time", CutOff::kAtTime},
                                            {"inertial_velocity", CutOff::kAtVelocity}});
  if (motor.cut_off == CutOff::kAtTime) motor.cut_off_s = cut.Quantity("after", kTime, kPositive);
  if (motor.cut_off == CutOff::kAtVelocity)
    motor.cut_off_velocity_m_s = cut.Quantity("velocity", kSpeed, kPositive);
}

// What an engine does by command in one of its burns.
void DecodeCommands(MapReader& map, const InputNode& node, Motor& motor, ProblemList& problems) {
  if (const InputNode* throttle = map.Optional("throttle"))
    motor.throttle =
        DecodeThrottle(*throttle, throttle->file == node.file ? map.PathOf("throttle") : "", problems);
  if (const InputNode* cut_off = map.Optional("cut_off"))
    DecodeCutOff(*cut_off, map.PathOf("cut_off"), motor, problems);
}

// An engine with tanks. Its full flow is thrust over specific impulse.
void DecodeLiquid(const InputNode& node, const std::string& path, double propellant_kg, Motor& motor,
                  ProblemList& problems) {
  MapReader map(node, path, problems);
  motor.thrust_n = map.Quantity("thrust", kForce, kPositive);
  const double specific_impulse_s = map.Quantity("specific_impulse", kTime, kPositive);
  motor.burning_time_s = propellant_kg * specific_impulse_s * kStandardGravity / motor.thrust_n;
  motor.residual_mass_kg = map.Quantity("residual_mass", kMass, kNonNegative, 0.0);
  DecodeCommands(map, node, motor, problems);
}

Tank DecodeTank(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Tank tank;
  tank.name = map.Text("name");
  tank.propellant_mass_kg = map.Quantity("propellant_mass", kMass, kPositive);
  tank.density_kg_m3 = map.Quantity("density", kDensity, kPositive);
  tank.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  tank.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  tank.diameter_m = map.Quantity("diameter", kLength, kPositive);
  return tank;
}

// What says the same in another way stands beside `other`.
void RefuseBeside(MapReader& map, const InputNode& node, const std::string& other, const std::string& why,
                  const std::string& allowed) {
  const std::pair<const char*, Dimension> contradicted[] = {
      {"thrust", kForce}, {"burning_time", kTime}, {"ignition_rise", kTime}, {"tail_off", kTime}};
  for (const auto& [stem, dimension] : contradicted) {
    std::string key;
    if (map.OptionalQuantity(stem, dimension, kAnyNumber, &key))
      AddProblem(map.problems(), *node.Find(key), map.PathOf(key),
                 "'" + key + "' and '" + other + "' are both given, and " + why, allowed);
  }
}

Motor DecodeMotor(const InputNode& node, const std::string& path, double propellant_kg, ProblemList& problems) {
  MapReader map(node, path, problems);
  Motor motor;
  motor.nozzle_exit_area_m2 = map.Quantity("nozzle_exit_area", kArea, kNonNegative, 0.0);
  const InputNode* liquid = map.Optional("liquid");
  const InputNode* curve = map.Optional("thrust_curve");
  if (liquid != nullptr) {
    const std::string allowed = "either liquid, or what a solid motor has";
    RefuseBeside(map, node, "liquid", "the engine has them inside", allowed);
    if (curve != nullptr)
      AddProblem(problems, *curve, map.PathOf("thrust_curve"), "'thrust_curve' and 'liquid' are both given", allowed);
    DecodeLiquid(*liquid, map.PathOf("liquid"), propellant_kg, motor, problems);
  } else if (curve != nullptr) {
    RefuseBeside(map, node, "thrust_curve", "the curve says it all",
                 "either thrust_curve, or thrust_* with burning_time_* and ramps");
    ThrustCurve found =
        DecodeThrustCurve(*curve, map.PathOf("thrust_curve"), motor.nozzle_exit_area_m2, problems);
    if (!found.empty())
      SetThrustCurve(std::move(found), motor);
    else
      motor.thrust_n = motor.burning_time_s = 1.0;  // harmless: what is wrong has been said
  } else {
    motor.thrust_n = map.Quantity("thrust", kForce, kPositive);
    motor.burning_time_s = map.Quantity("burning_time", kTime, kPositive);
    motor.ignition_rise_s = map.Quantity("ignition_rise", kTime, kNonNegative, 0.0);
    motor.tail_off_s = map.Quantity("tail_off", kTime, kNonNegative, 0.0);
  }
  motor.published_mass_flow_kg_s = map.Quantity("published_mass_flow", kMassFlow, kNonNegative, 0.0);
  return motor;
}

Grain DecodeGrain(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Grain grain;
  grain.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  grain.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  grain.outer_diameter_m = map.Quantity("outer_diameter", kLength, kPositive);
  grain.inner_diameter_m = map.Quantity("inner_diameter", kLength, kNonNegative);
  return grain;
}

MassElement DecodeMassElement(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  MassElement element;
  element.name = map.Text("name");
  element.fraction = map.Number("fraction", Between(0.0, 1.0));
  element.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  element.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  element.outer_diameter_m = map.Quantity("outer_diameter", kLength, kPositive);
  element.inner_diameter_m = map.Quantity("inner_diameter", kLength, kNonNegative, 0.0);
  return element;
}

// One of `count` nozzles of a list.
Nozzle DecodeListedNozzle(const InputNode& node, const std::string& path, std::size_t count,
                          ProblemList& problems) {
  MapReader map(node, path, problems);
  Nozzle nozzle;
  nozzle.name = map.Text("name");
  nozzle.y_m = map.Quantity("y", kLength, kAnyNumber, 0.0);
  nozzle.z_m = map.Quantity("z", kLength, kAnyNumber, 0.0);
  nozzle.thrust_share = map.Number("thrust_share", {0.0, 1.0, true, false}, 1.0 / static_cast<double>(count));
  nozzle.towards_rad = map.Quantities("turns_towards", kAngle, Between(-2.0 * kPi, 2.0 * kPi), 0, 2);
  nozzle.limit_rad = map.Quantity("limit", kAngle, {0.0, kQuarterTurn, true, true}, 0.0);
  return nozzle;
}

Gimbal DecodeGimbal(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Gimbal gimbal;
  gimbal.pivot_station_m = map.Quantity("pivot_station", kLength, kPositive);
  const InputNode* const list = node.Find("nozzles");
  map.Each("nozzles", 0, kNozzles, [&](const InputNode& item, const std::string& item_path) {
    gimbal.nozzles.push_back(DecodeListedNozzle(item, item_path, list->items.size(), problems));
  });
  if (list == nullptr || list->items.empty()) gimbal.radius_m = map.Quantity("radius", kLength, kPositive);
  gimbal.limit_rad = map.Quantity("limit", kAngle, {0.0, kQuarterTurn, true, true});
  gimbal.rate_limit_rad_s = map.Quantity("rate_limit", kAngularRate, kPositive);
  gimbal.bandwidth_rad_s = map.Quantity("bandwidth", kFrequency, kPositive);
  gimbal.damping_ratio = map.Number("damping_ratio", kPositive);
  gimbal.delay_ticks = static_cast<int>(map.Integer("delay_ticks", 0, 100));
  gimbal.dead_zone_rad = map.Quantity("dead_zone", kAngle, kNonNegative, 0.0);
  gimbal.friction_rad = map.Quantity("friction", kAngle, kNonNegative, 0.0);
  gimbal.resolution_rad = map.Quantity("resolution", kAngle, kNonNegative, 0.0);
  return gimbal;
}

Jettison DecodeJettison(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Jettison jettison;
  jettison.name = map.Text("name");
  jettison.mass_kg = map.Quantity("mass", kMass, kPositive);
  jettison.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  jettison.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  jettison.outer_diameter_m = map.Quantity("outer_diameter", kLength, kPositive);
  jettison.inner_diameter_m = map.Quantity("inner_diameter", kLength, kNonNegative, 0.0);
  MapReader at(map.Required("at", "a map"), map.PathOf("at"), problems);
  int given = 0;
  const auto take = [&](const char* stem, Dimension dimension, JettisonTrigger trigger) {
    const std::optional<double> threshold = at.OptionalQuantity(stem, dimension, kPositive);
    if (!threshold) return;
    ++given;
    jettison.trigger = trigger;
    jettison.threshold = *threshold;
  };
  take("time", kTime, JettisonTrigger::kAtTime);
  take("altitude", kLength, JettisonTrigger::kAtAltitude);
  take("heat_flux", kHeatFlux, JettisonTrigger::kAtHeatFlux);
  if (given == 0)
    at.ReportMissing({"time_s", "altitude_km", "heat_flux_w_m2"}, "one of them");
  else if (given > 1)
    AddProblem(problems, at.node(), at.path(), "says more than once when",
               "time_s, altitude_km or heat_flux_w_m2");
  return jettison;
}

void DecodeIgnition(const InputNode& node, const std::string& path, Stage& stage, ProblemList& problems) {
  MapReader ignition(node, path, problems);
  stage.ignition =
      ignition.Choice<IgnitionTrigger>("trigger", {{"lift_off", IgnitionTrigger::kLiftOff},
                                                   {"burnout_detection", IgnitionTrigger::kBurnoutDetection},
                                                   {"timer", IgnitionTrigger::kTimer}});
  stage.ignition_delay_s = ignition.Quantity("delay", kTime, kNonNegative, 0.0);
}

void ReadRestart(MapReader& map, Stage& stage, ProblemList& problems) {
  map.Flag("restarts", true);
  stage.name = map.Text("name");
  stage.motor.throttle = {};
  stage.motor.cut_off = CutOff::kAtDepletion;
  DecodeCommands(map, map.node(), stage.motor, problems);
  DecodeIgnition(map.Required("ignition", "a map"), map.PathOf("ignition"), stage, problems);
  stage.separation_delay_s = map.Quantity("separation_delay", kTime, kNonNegative, 0.0);
}

// Another burn of the stage before: its body, and what its engine is commanded now. `before` gives up what it
// would jettison, which stays on until the last burn has ended.
Stage DecodeRestart(const InputNode& node, const std::string& path, Stage* before, ProblemList& problems) {
  MapReader map(node, path, problems);
  if (before == nullptr || !before->is_liquid()) {
    AddProblem(problems, *node.Find("restarts"), map.PathOf("restarts"),
               before == nullptr ? "there is no stage before" : "the stage before has no liquid engine",
               "restarts: true after a stage with motor: {liquid: {...}}");
    for (const InputMember& member : node.members) map.Ignore(member.key);
    // Nothing more is said of it, but read it is.
    Stage nothing;
    ProblemList unsaid;
    MapReader again(node, path, unsaid);
    ReadRestart(again, nothing, unsaid);
    return {};
  }
  Stage stage = *before;
  before->jettisoned.clear();
  stage.restarts = true;
  ReadRestart(map, stage, problems);
  // What the burn before leaves; of a cut-off by velocity a flight tells, and until then all stands for it.
  const Motor& first = before->motor;
  if (first.cut_off == CutOff::kAtVelocity || !(first.thrust_n > 0.0 && first.burning_time_s > 0.0))
    return stage;
  const double left = BuildBurn(*before, 1.0, 1.0).left_kg / before->propellant_mass_kg;
  stage.liftoff_mass_kg -= (1.0 - left) * before->propellant_mass_kg;
  stage.propellant_mass_kg *= left;
  stage.motor.burning_time_s *= left;
  for (Tank& tank : stage.tanks) tank.propellant_mass_kg *= left;
  return stage;
}

Stage DecodeStage(const InputNode& node, const std::string& path, Stage* before, ProblemList& problems) {
  if (const InputNode* restarts = node.Find("restarts"); restarts != nullptr && restarts->text != "false")
    return DecodeRestart(node, path, before, problems);
  MapReader map(node, path, problems);
  Stage stage;
  map.Flag("restarts", false);
  stage.name = map.Text("name");
  stage.liftoff_mass_kg = map.Quantity("liftoff_mass", kMass, kPositive);
  stage.propellant_mass_kg = map.Quantity("propellant_mass", kMass, kPositive);
  stage.diameter_m = map.Quantity("diameter", kLength, kPositive);
  stage.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  const InputNode& motor = map.Required("motor", "a map");
  stage.motor = DecodeMotor(motor, map.PathOf("motor"), stage.propellant_mass_kg, problems);
  const InputNode* tanks = map.Optional("tanks");
  if (motor.Find("liquid") != nullptr) {
    if (const InputNode* grain = map.Optional("grain"))
      AddProblem(problems, *grain, map.PathOf("grain"), "the motor is liquid", "tanks in place of the grain");
    map.Each("tanks", 1, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      stage.tanks.push_back(DecodeTank(item, item_path, problems));
    });
  } else {
    if (tanks != nullptr)
      AddProblem(problems, *tanks, map.PathOf("tanks"), "the motor is not liquid",
                 "a grain in place of the tanks, or motor: {liquid: {...}}");
    stage.grain = DecodeGrain(map.Required("grain", "a map"), map.PathOf("grain"), problems);
  }
  map.Each("structure", 1, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
    stage.structure.push_back(DecodeMassElement(item, item_path, problems));
  });
  map.Each("jettisoned", 0, kMaxJettisons, [&](const InputNode& item, const std::string& item_path) {
    stage.jettisoned.push_back(DecodeJettison(item, item_path, problems));
  });
  stage.gimbal = DecodeGimbal(map.Required("gimbal", "a map"), map.PathOf("gimbal"), problems);
  DecodeIgnition(map.Required("ignition", "a map"), map.PathOf("ignition"), stage, problems);
  stage.separation_delay_s = map.Quantity("separation_delay", kTime, kNonNegative, 0.0);
  return stage;
}

Boosters DecodeBoosters(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Boosters boosters;
  boosters.count = static_cast<int>(map.Integer("count", 2, kMaxBoosters));
  boosters.dry_mass_kg = map.Quantity("dry_mass", kMass, kPositive);
  boosters.propellant_mass_kg = map.Quantity("propellant_mass", kMass, kPositive);
  boosters.radius_m = map.Quantity("radius", kLength, kPositive);
  boosters.diameter_m = map.Quantity("diameter", kLength, kPositive);
  boosters.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  boosters.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  boosters.nozzle_station_m = map.Quantity("nozzle_station", kLength, kPositive);
  const InputNode& motor = map.Required("motor", "a map");
  if (motor.Find("liquid") != nullptr)
    AddProblem(problems, *motor.Find("liquid"), map.PathOf("motor.liquid"), "boosters are solid",
               "thrust_* with burning_time_*, or thrust_curve");
  else
    boosters.motor = DecodeMotor(motor, map.PathOf("motor"), boosters.propellant_mass_kg, problems);
  boosters.grain = DecodeGrain(map.Required("grain", "a map"), map.PathOf("grain"), problems);
  boosters.separation_delay_s = map.Quantity("separation_delay", kTime, kNonNegative, 0.0);
  return boosters;
}

ProfileSection DecodeProfileSection(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  ProfileSection section;
  section.shape = map.Choice<ProfileShape>("shape", {{"tangent_ogive", ProfileShape::kTangentOgive},
                                                     {"cone", ProfileShape::kCone},
                                                     {"cylinder", ProfileShape::kCylinder},
                                                     {"frustum", ProfileShape::kFrustum}});
  section.length_m = map.Quantity("length", kLength, kPositive);
  section.aft_diameter_m = map.Quantity("aft_diameter", kLength, kPositive);
  return section;
}

// The rows of a table, one a grid point, to the grid: mach by mach, each with the same incidences.
void GridRows(const InputNode& node, const std::string& path, AeroTable& table, ProblemList& problems) {
  std::vector<double> mach;
  std::vector<double> incidence_rad;
  std::vector<double> cmq_per_rad;
  std::vector<double> clp_per_rad;
  const std::size_t before = problems.size();
  {
    MapReader map(node, path, problems);
    mach = map.Numbers("mach", kNonNegative, 4);
    incidence_rad = map.Quantities("incidence", kAngle, Between(0.0, kHalfTurn), 4);
    table.ca = map.Numbers("ca", kAnyNumber, 4);
    table.cn = map.Numbers("cn", kAnyNumber, 4);
    table.xcp_station_m = map.Quantities("xcp_station", kLength, kAnyNumber, 4);
    cmq_per_rad = map.Numbers("cmq_per_rad", kAnyNumber, 4);
    clp_per_rad = map.Numbers("clp_per_rad", kAnyNumber, 4);
  }
  if (node.file == nullptr || problems.size() > before) return;
  const std::size_t rows = mach.size();
  for (const auto* column :
       {&incidence_rad, &table.ca, &table.cn, &table.xcp_station_m, &cmq_per_rad, &clp_per_rad}) {
    if (column->size() == rows) continue;
    AddProblem(problems, node, path, "the columns have different lengths", "one value a row in each column");
    return;
  }
  const std::size_t incidences = static_cast<std::size_t>(
      std::find_if(mach.begin(), mach.end(), [&](double value) { return value != mach.front(); }) -
      mach.begin());
  table.incidence_rad.assign(incidence_rad.begin(),
                             incidence_rad.begin() + static_cast<std::ptrdiff_t>(incidences));
  const std::string allowed =
      "a full grid: rows of increasing mach, each mach with the same increasing incidences, two or more of "
      "both";
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t column = row % incidences;
    const bool starts_mach = column == 0;
    const bool mach_fits = starts_mach ? (row == 0 || mach[row] > mach[row - 1]) : mach[row] == mach[row - 1];
    const bool incidence_fits = incidence_rad[row] == table.incidence_rad[column] &&
                                (starts_mach || incidence_rad[row] > incidence_rad[row - 1]);
    const bool last_is_partial = row + 1 == rows && column + 1 != incidences;
    if (!mach_fits || !incidence_fits || last_is_partial || incidences < 2 || incidences == rows) {
      AddProblem(problems, node.Find("mach")->items[row], path, "the row does not continue the grid",
                 allowed);
      return;
    }
    if (!starts_mach &&
        (cmq_per_rad[row] != cmq_per_rad[row - 1] || clp_per_rad[row] != clp_per_rad[row - 1])) {
      AddProblem(problems, node.Find("cmq_per_rad")->items[row], path,
                 "the rate damping changes with incidence",
                 "the same cmq_per_rad and clp_per_rad in all rows of a mach number");
      return;
    }
    if (!starts_mach) continue;
    table.mach.push_back(mach[row]);
    table.cmq_per_rad.push_back(cmq_per_rad[row]);
    table.clp_per_rad.push_back(clp_per_rad[row]);
  }
}

AeroTable DecodeAeroTable(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  AeroTable table;
  table.reference_area_m2 = map.Quantity("reference_area", kArea, kPositive);
  table.reference_length_m = map.Quantity("reference_length", kLength, kPositive);
  const InputNode& rows = map.Required("table", "a CSV file");
  GridRows(rows, rows.file == node.file ? map.PathOf("table") : "", table, problems);
  return table;
}

ReactionControl DecodeReactionControl(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  ReactionControl control;
  control.thrust_n = map.Quantity("thrust", kForce, kPositive);
  control.pitch_yaw_arm_m = map.Quantity("pitch_yaw_arm", kLength, kPositive);
  control.roll_arm_m = map.Quantity("roll_arm", kLength, kPositive);
  control.specific_impulse_s = map.Quantity("specific_impulse", kTime, kPositive);
  control.minimum_on_time_s = map.Quantity("minimum_on_time", kTime, kNonNegative);
  return control;
}

// What turns of one nozzle of a stage.
void DecodeNozzle(const InputNode& node, const std::string& path, Gimbal& gimbal, ProblemList& problems) {
  MapReader map(node, path, problems);
  gimbal.nozzle_mass_kg = map.Quantity("mass", kMass, kPositive);
  gimbal.nozzle_cg_m = map.Quantity("cg_aft_of_pivot", kLength, kAnyNumber);
  gimbal.nozzle_inertia_kg_m2 = map.Quantity("inertia_about_hinge", kInertia, kPositive);
}

RateGyro DecodeGyro(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  RateGyro gyro;
  gyro.name = map.Text("name");
  gyro.station_m = map.Quantity("station", kLength, kNonNegative);
  gyro.bandwidth_rad_s = map.Quantity("bandwidth", kFrequency, kPositive, 0.0);
  gyro.damping_ratio = map.Number("damping_ratio", kPositive, 0.7);
  gyro.quantum_rad_s = map.Quantity("quantum", kAngularRate, kPositive, 0.0);
  gyro.sample_ticks = static_cast<int>(map.Integer("sample_ticks", 1, 100, 1));
  return gyro;
}

Sensors DecodeSensors(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Sensors sensors;
  {
    MapReader unit(map.Required("inertial_unit", "a map"), map.PathOf("inertial_unit"), problems);
    sensors.inertial_unit_station_m = unit.Quantity("station", kLength, kNonNegative);
  }
  map.Each("rate_gyros", 0, kRateGyros, [&](const InputNode& item, const std::string& item_path) {
    sensors.rate_gyros.push_back(DecodeGyro(item, item_path, problems));
  });
  return sensors;
}

StructuralLimits DecodeLimits(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  StructuralLimits limits;
  limits.q_max_pa = map.Quantity("q_max", kPressure, kPositive, 0.0);
  limits.q_alpha_pa_rad = map.Quantity("q_alpha", kPressureAngle, kPositive, 0.0);
  limits.axial_load_g = map.Quantity("axial_load", kAcceleration, kPositive, 0.0);
  limits.lateral_load_g = map.Quantity("lateral_load", kAcceleration, kPositive, 0.0);
  limits.bending_moment_n_m = map.Quantity("bending_moment", kMoment, kPositive, 0.0);
  limits.terminate = map.Flag("terminate", false);
  return limits;
}

// A motor's table is in a file that could not be read, which has been said: what stands in its place is not the
// vehicle's.
bool HasUnreadTable(const InputNode& vehicle) {
  const InputNode* stages = vehicle.Find("stages");
  if (stages == nullptr) return false;
  for (const InputNode& stage : stages->items) {
    const InputNode* motor = stage.Find("motor");
    if (motor == nullptr) continue;
    for (const auto& [map, table] : {std::pair{"thrust_curve", "table"}, {"liquid", "throttle"}}) {
      const InputNode* within = motor->Find(map);
      const InputNode* found = within == nullptr ? nullptr : within->Find(table);
      if (found != nullptr && found->file == nullptr) return true;
    }
  }
  return false;
}

void CheckPlausibility(const Vehicle& vehicle, const InputNode& node, const std::string& path,
                       ProblemList& problems, ProblemList* warnings) {
  std::vector<PlausibilityFinding> impossible, unusual;
  for (PlausibilityFinding& finding : Plausibility(vehicle))
    (finding.impossible ? impossible : unusual).push_back(std::move(finding));
  AddStructProblems(impossible, node, path, problems);
  if (warnings == nullptr) return;
  const std::size_t before = warnings->size();
  AddStructProblems(unusual, node, path, *warnings);
  for (std::size_t i = before; i < warnings->size(); ++i) (*warnings)[i].unusual = true;
}

}  // namespace

Vehicle DecodeVehicle(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                      std::vector<InputProblem>* warnings) {
  const std::size_t before = problems.size();
  Vehicle vehicle;
  if (node.file == nullptr) return vehicle;  // already reported
  if (!CheckSchema(node, kVehicleSchema, !path.empty(), path, problems)) return vehicle;
  {
    MapReader map(node, path, problems);
    map.Allow("schema");
    // Which InlineVehicleFiles has put in its place.
    SayKnows(path, {"based_on"});
    SayExpects(map.PathOf("based_on"), {.kind = Expectation::Kind::kFile});
    vehicle.name = map.Text("name");
    vehicle.site = DecodeSite(map.Required("site", "a map"), map.PathOf("site"), problems);
    vehicle.hold_down_s = map.Quantity("hold_down", kTime, kNonNegative, 0.0);
    vehicle.made_up = map.Flag("made_up", false);
    vehicle.jet_damping = map.Flag("jet_damping", true);
    vehicle.flow_coriolis = map.Flag("flow_coriolis", true);
    vehicle.surface_roughness_m = map.Quantity("surface_roughness", kLength, kNonNegative, 0.0);
    map.Each("stages", 1, kMaxStages, [&](const InputNode& item, const std::string& item_path) {
      Stage* const last = vehicle.stages.empty() ? nullptr : &vehicle.stages.back();
      vehicle.stages.push_back(DecodeStage(item, item_path, last, problems));
    });
    if (const InputNode* boosters = map.Optional("boosters"))
      vehicle.boosters = DecodeBoosters(*boosters, map.PathOf("boosters"), problems);
    // They have left before the first stage burns again.
    for (std::size_t i = 1; i < vehicle.stages.size() && vehicle.stages[i].restarts; ++i)
      vehicle.stages[i].liftoff_mass_kg -= vehicle.boosters.LiftOffMass();
    map.Each("profile", 1, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      vehicle.profile.push_back(DecodeProfileSection(item, item_path, problems));
    });
    if (const InputNode* aerodynamics = map.Optional("aerodynamics")) {
      MapReader tables(*aerodynamics, map.PathOf("aerodynamics"), problems);
      tables.Each("tables", 1, kMaxStages, [&](const InputNode& item, const std::string& item_path) {
        vehicle.aerodynamics.push_back(DecodeAeroTable(item, item_path, problems));
      });
    }
    // A single stage has no coast.
    const bool may_lack = vehicle.stages.size() == 1;
    const InputNode* const thrusters =
        may_lack ? map.Optional("reaction_control") : &map.Required("reaction_control", "a map");
    if (thrusters != nullptr)
      vehicle.reaction_control = DecodeReactionControl(*thrusters, map.PathOf("reaction_control"), problems);
    if (const InputNode* limits = map.Optional("limits")) {
      vehicle.limits = DecodeLimits(*limits, map.PathOf("limits"), problems);
    }
    const std::size_t stages = vehicle.stages.size();
    std::size_t stage = 0;
    SayExpects(map.PathOf("nozzles"), {.kind = Expectation::Kind::kList, .high_count = kMaxStages});
    map.Each("nozzles", 0, stages, [&](const InputNode& item, const std::string& item_path) {
      DecodeNozzle(item, item_path, vehicle.stages[stage++].gimbal, problems);
    });
    if (stage != 0 && stage != stages)
      AddProblem(
          problems, *node.Find("nozzles"), map.PathOf("nozzles"),
          "the list has " + std::to_string(stage) + ", the vehicle " + std::to_string(stages) + " stages",
          "one entry a stage, or none");
    const InputNode* sensors = map.Optional("sensors");
    if (sensors != nullptr) vehicle.sensors = DecodeSensors(*sensors, map.PathOf("sensors"), problems);
    if (const InputNode* beam = map.Optional("structure_beam")) {
      vehicle.structure_beam =
          DecodeStructureBeam(*beam, map.PathOf("structure_beam"), vehicle.stages.size(), problems);
      if (sensors == nullptr && vehicle.structure_beam && vehicle.structure_beam->flown_modes > 0)
        map.ReportMissing({"sensors"}, "where the sensors of a vehicle that bends are: sensors: "
                                       "{inertial_unit: {station_m: x}}");
    }
  }
  if (HasUnreadTable(node)) return vehicle;
  if (problems.size() == before) AddStructProblems(Problems(vehicle), node, path, problems);
  if (problems.size() == before) CheckPlausibility(vehicle, node, path, problems, warnings);
  return vehicle;
}

}  // namespace dispersa
