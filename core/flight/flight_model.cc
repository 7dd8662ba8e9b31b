#include "core/flight/flight_model.h"

#include <algorithm>

#include "core/dynamics/aero_grid.h"
#include "core/dynamics/jettison.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/random/draws.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

namespace {

BoosterSet BuildBoosterSet(const Boosters& boosters, double thrust_factor, double flow_factor) {
  return {BuildBoosterBurn(boosters, thrust_factor, flow_factor),
          BuildBoosterPropellant(boosters),
          BuildBoosterMass(boosters),
          boosters.nozzle_station_m,
          boosters.attachment_station_m,
          boosters.radius_m,
          boosters.separation_delay_s,
          {},
          boosters.gimbal,
          {}};
}

// Differences of one booster from the nominal one.
struct BoosterDeparture {
  double thrust_factor = 1.0, flow_factor = 1.0;
  Matrix3 tilt = Matrix3::Identity();
};
EachBooster BuildEachBooster(const DispersedBooster& dispersed, std::size_t k, double thrust_factor,
                             double flow_factor, const BoosterDeparture& departs) {
  const Boosters& boosters = dispersed.one;
  EachBooster one;
  one.burn =
      BuildOneBoosterBurn(boosters, thrust_factor * departs.thrust_factor, flow_factor * departs.flow_factor);
  one.dry_kg = boosters.dry_mass_kg;
  one.tanks = dispersed.mixture.tanks;
  const SinCos at = SineCosine(boosters.angles_rad[k]);
  one.y_m = boosters.radius_m * at.cos;
  one.z_m = boosters.radius_m * at.sin;
  const Matrix3 turn = departs.tilt * CantOf(boosters, boosters.angles_rad[k]);
  one.along = turn * Vector3::UnitX();
  const auto across = [&](std::size_t hinge) -> Vector3 {
    if (hinge >= boosters.towards_rad.size()) return Vector3::Zero();
    const SinCos towards = SineCosine(boosters.towards_rad[hinge]);
    return turn * Vector3(0.0, towards.cos, towards.sin);
  };
  one.first = across(0);
  one.second = across(1);
  return one;
}

// The ratio of thrusts in vacuum, and levers in the middle of the boosters' burn.
BoostGeometry GeometryOf(const LauncherPlant& plant) {
  const BoosterSet& set = *plant.boosters;
  const LauncherStack& stack = plant.stacks[0];
  const double middle_s = 0.5 * set.burn.duration_s;
  const double cg_m = MassesOn(plant, 0, 0u, stack.burn.Propellant(middle_s), middle_s).cg_station_m;
  return {set.each[0].burn.vacuum_thrust_n / stack.burn.vacuum_thrust_n, stack.gimbal.pivot_station_m - cg_m,
          set.nozzle_station_m - cg_m};
}

// The propellant that a burn leaves is available to the next burn of the same engine.
void PassOnPropellant(const Vehicle& vehicle, std::size_t from, LauncherPlant& plant) {
  for (std::size_t i = from + 1; i < plant.stacks.size() && vehicle.stages[i].restarts; ++i)
    SetPropellant(vehicle.stages[i].motor, plant.stacks[i - 1].burn.left_kg, plant.stacks[i].burn);
}

// Where the ascent of the reference never reaches the cut-off before the last restart, because the reference
// is of another vehicle, nothing is left to restart with. Then the last burn takes until the program's end,
// and the burn before leaves what that takes.
void LeaveForRestart(const FlightDefinition& definition, LauncherPlant& planned) {
  const std::size_t last = planned.stacks.size() - 1;
  const Stage& stage = definition.vehicle.stages[last];
  if (!stage.restarts || !EndsInFlight(stage.motor) || definition.cut_off_s[last] < HUGE_VAL) return;
  const double burns_s = definition.program.knots.back().time_s - definition.last_ignition_s;
  if (!(burns_s > 0.0)) return;
  MotorBurn& before = planned.stacks[last - 1].burn;
  const double takes_kg =
      planned.stacks[last].burn.full_flow_kg_s * EngineLevels(stage.motor.throttle).Sum(burns_s);
  const double burnt_kg = std::max(before.propellant_mass_kg - stage.motor.residual_mass_kg - takes_kg, 0.0);
  const EngineLevels levels(definition.vehicle.stages[last - 1].motor.throttle);
  CutOffAt(levels.TimeOf(burnt_kg / before.full_flow_kg_s), before);
  PassOnPropellant(definition.vehicle, last - 1, planned);
  CutOffAt(burns_s, planned.stacks[last].burn);
}

// The bodies of a configuration, as bits of LauncherPhase::jettisoned.
unsigned BitsOf(const Vehicle& vehicle, const AeroConfiguration& configuration) {
  unsigned bits = 0, bit = 1;
  const auto is_named = [&](const std::string& name) {
    const std::vector<std::string>& names = configuration.without;
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const Stage& stage : vehicle.stages)
    for (const Jettison& jettison : stage.jettisoned) {
      if (is_named(jettison.name)) bits |= bit;
      bit <<= 1;
    }
  return is_named(kBoostersName) ? bits | kBoostersGone : bits;
}

AeroVariant VariantOf(const AeroTable& table, unsigned without, bool power_off) {
  AeroVariant variant{without, power_off, FromTable(table), nullptr};
  if (power_off) {
    variant.body.ca.table.z = table.ca_power_off;
    if (variant.body.has_yaw_plane()) variant.body.ca_yaw.table.z = table.yaw_plane.front().ca_power_off;
  }
  variant.grid = std::make_shared<const AeroGrid>(BuildAeroGrid(variant.body));
  return variant;
}

void SetAerodynamics(const Vehicle& vehicle, const AeroTable& table, LauncherStack& stack) {
  AeroVariant whole = VariantOf(table, 0, false);
  stack.aerodynamics = std::move(whole.body);
  stack.aero_grid = std::move(whole.grid);
  std::vector<AeroVariant> variants;
  if (!table.ca_power_off.empty()) variants.push_back(VariantOf(table, 0, true));
  for (const AeroConfiguration& lighter : table.lighter) {
    const unsigned without = BitsOf(vehicle, lighter);
    variants.push_back(VariantOf(lighter.table, without, false));
    if (!lighter.table.ca_power_off.empty()) variants.push_back(VariantOf(lighter.table, without, true));
  }
  stack.aero_variants =
      variants.empty() ? nullptr : std::make_shared<const std::vector<AeroVariant>>(std::move(variants));
}

void SetMassesAndLoads(const Vehicle& vehicle, LauncherPlant& plant) {
  plant.jettisoned_masses = BuildJettisonedMasses(vehicle);
  const std::vector<StackMass> masses = BuildStackMasses(vehicle);
  for (std::size_t i = 0; i < masses.size(); ++i) {
    LauncherStack& stack = plant.stacks[i];
    stack.mass = masses[i];
    stack.mass_rows = vehicle.stages[i].flown_mass.rows;
    if (vehicle.stages[i].restarts)
      stack.loads = plant.stacks[i - 1].loads;
    else if (HasSectionLoads(vehicle))
      stack.loads =
          std::make_shared<const LoadTable>(BuildLoadTable(vehicle, static_cast<int>(i), stack.loads.get()));
  }
}

// `modes_of`: those of a stage's stack.
template <typename ModesOf>
void SetModes(const Vehicle& vehicle, const ModesOf& modes_of, LauncherPlant& plant) {
  for (std::size_t i = 0; i < plant.stacks.size(); ++i) {
    LauncherStack& stack = plant.stacks[i];
    stack.modes = vehicle.stages[i].restarts ? plant.stacks[i - 1].modes : modes_of(i, stack);
    stack.bending = stack.modes ? stack.modes->Without(0u) : nullptr;
  }
}

}  // namespace

LauncherPlant BuildNominalPlant(const Vehicle& vehicle) {
  if (vehicle.boosters.angles_rad.empty() && vehicle.boosters.count > 0) {
    Vehicle spread = vehicle;
    SpreadOut(spread.boosters);
    return BuildNominalPlant(spread);
  }
  LauncherPlant plant;
  plant.jet_damping = vehicle.jet_damping;
  plant.flow_coriolis = vehicle.flow_coriolis;
  const std::vector<AeroTable> tables = AerodynamicsOf(vehicle);
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    LauncherStack stack;
    SetAerodynamics(vehicle, tables[i], stack);
    stack.burn = BuildBurn(stage, 1.0, 1.0);
    stack.gimbal = stage.gimbal;
    stack.layout = BuildNozzleLayout(stage.gimbal);
    plant.stacks.push_back(stack);
    plant.jettisons.insert(plant.jettisons.end(), stage.jettisoned.begin(), stage.jettisoned.end());
  }
  SetMassesAndLoads(vehicle, plant);
  if (const Boosters& boosters = vehicle.boosters; boosters.count > 0) {
    BoosterSet set = BuildBoosterSet(boosters, 1.0, 1.0);
    for (std::size_t k = 0; k < boosters.angles_rad.size(); ++k)
      set.each.push_back(BuildEachBooster(BoosterOf(vehicle, {}, k), k, 1.0, 1.0, {}));
    plant.boosters = std::make_shared<const BoosterSet>(set);
    if (boosters.turn_nozzles()) {
      set.layout = BuildBoostLayout(vehicle.stages[0].gimbal, boosters, GeometryOf(plant));
      plant.boosters = std::make_shared<const BoosterSet>(std::move(set));
    }
  }
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i)
    if (!vehicle.stages[i].restarts) PassOnPropellant(vehicle, i, plant);
  return plant;
}

void SetMasses(const std::shared_ptr<const Vehicle>& vehicle, LauncherPlant& plant) {
  SetMassesAndLoads(*vehicle, plant);
  SetModes(
      *vehicle,
      [&](std::size_t, const LauncherStack& stack) {
        return stack.modes ? stack.modes->Of(vehicle, stack.loads) : nullptr;
      },
      plant);
}

void CommandCutOffOf(const Vehicle& vehicle, int stage, double since_ignition_s, LauncherPlant& plant) {
  const std::size_t i = static_cast<std::size_t>(stage);
  CommandCutOff(vehicle.stages[i].motor, since_ignition_s, plant.stacks[i].burn);
  PassOnPropellant(vehicle, i, plant);
}

void AddBending(const Vehicle& vehicle, double tick_s, LauncherPlant& plant) {
  const auto kept = std::make_shared<const Vehicle>(vehicle);
  SetModes(
      vehicle,
      [&](std::size_t stage, const LauncherStack& stack) {
        return FlownModesBelow(kPi / tick_s, kept, static_cast<int>(stage), stack.loads);
      },
      plant);
}

namespace {

unsigned GoneAt(const std::vector<double>& jettison_s, double time_s) {
  unsigned gone = 0;
  for (std::size_t i = 0; i < jettison_s.size(); ++i)
    if (jettison_s[i] <= time_s) gone |= 1u << i;
  return gone;
}

// So many even ones, and the corners of the thrust's level between them.
// `jump_s`: a time at which the effectiveness jumps (below 0: none).
std::vector<double> EffectivenessTimes(const MotorBurn& burn, double duration_s, int even, double jump_s) {
  std::vector<double> times;
  for (int i = 0; i < even; ++i) times.push_back(duration_s * i / (even - 1));
  constexpr double kJump_s = 1e-3;
  if (jump_s > kJump_s && jump_s < duration_s - 2.0 * kJump_s)
    times.insert(times.end(), {jump_s - kJump_s, jump_s + kJump_s});
  if (!burn.curve) {
    std::sort(times.begin(), times.end());
    return times;
  }
  const std::vector<double>& begin_s = burn.curve->begin_s;
  for (std::size_t i = 0; i < begin_s.size(); ++i) {
    const double from_s = begin_s[i] / burn.curve_rate,
                 to_s = (i + 1 < begin_s.size() ? begin_s[i + 1] : burn.curve->end_s) / burn.curve_rate;
    times.push_back(from_s);
    // Where the level that the autopilot takes at least begins or ends.
    const double from = burn.Fraction(from_s) - kLeastThrustFraction,
                 to = burn.Fraction(to_s) - kLeastThrustFraction;
    if ((from < 0.0) != (to < 0.0)) times.push_back(from_s + (to_s - from_s) * from / (from - to));
  }
  constexpr double kLeastStep_s = 1e-6;
  std::sort(times.begin(), times.end());
  std::vector<double> apart = {0.0};
  for (const double time_s : times)
    if (time_s > apart.back() + kLeastStep_s && time_s < duration_s - kLeastStep_s) apart.push_back(time_s);
  apart.push_back(duration_s);
  return apart;
}

}  // namespace

namespace {

// Moments about x and y by a radian commanded about each, while boosters with turning nozzles burn: each
// drive by the thrust that it turns at that time. Thrust of the stage and its lever are given. Where boosters
// alone turn the vehicle, their thrust counts as kLeastThrustFraction at least: in roll, and in pitch beside
// a stage whose nozzles stay centred.
Vector2 BoostedMoments(const LauncherPlant& plant, double thrust_n, double lever_m, double cg_station_m,
                       double since_s) {
  const BoosterSet& set = *plant.boosters;
  const NozzleLayout& layout = set.layout;
  const int first = plant.stacks[0].layout.banks() * kNozzles;
  Vector2 moment = Vector2::Zero(), by_boosters = Vector2::Zero(), at_least = Vector2::Zero();
  for (int drive = 0; drive < layout.banks() * kDrives; ++drive) {
    const int k = NozzleOf(drive);
    if (!(layout.there[drive] > 0.0)) continue;
    const Vector3 towards(0.0, layout.towards_y[drive], layout.towards_z[drive]);
    Vector3 force = layout.share[k] * thrust_n * towards, arm(-lever_m, layout.y_m[k], layout.z_m[k]);
    double level = 1.0;
    if (k >= first) {
      const EachBooster& one = set.each[static_cast<std::size_t>(k - first)];
      if (one.burn.curve) level = one.burn.Fraction(since_s);
      const bool is_second = drive % kDrives >= kNozzles;
      force = one.burn.vacuum_thrust_n * (is_second ? one.second : one.first);
      arm.x() = cg_station_m - set.nozzle_station_m;
    }
    const Vector3 by_radian = arm.cross(force);
    const Vector2 commanded(layout.allocation[drive][0] * by_radian.x(),
                            layout.allocation[drive][1] * by_radian.y());
    if (k < first) {
      moment += commanded;
    } else {
      by_boosters += level * commanded;
      at_least += std::max(level, kLeastThrustFraction) * commanded;
    }
  }
  const auto both = [&](int axis) {
    return moment[axis] + (moment[axis] == 0.0 ? at_least[axis] : by_boosters[axis]);
  };
  return {both(0), both(1)};
}

}  // namespace

StageControl BuildStageControl(const LauncherPlant& plant, int index, double ignition_s,
                               const std::vector<double>& jettison_s) {
  const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(index)];
  // Under constant thrust the effectiveness changes slowly and smoothly: 33 points follow it to a part in a
  // thousand. With a thrust curve it has the curve's corners besides; ignition and tail-off ramps are not in
  // the table. At a jettison it jumps, and the table follows the jump as closely.
  const bool jumps = (index == 0 && plant.boosters) || !plant.jettisons.empty();
  const int points = stack.burn.curve || jumps ? 1025 : 33;
  // A restart of a reference that leaves it nothing: any time at all.
  const double duration_s = std::max(stack.burn.duration_s, 1e-3);
  StageControl control;
  control.limit_rad = stack.gimbal.limit_rad;
  const bool boosters_steer = index == 0 && plant.boosters_steer();
  const double boost_s = boosters_steer ? plant.boosters->burn.duration_s : -1.0;
  for (const double since : EffectivenessTimes(stack.burn, duration_s, points, boost_s)) {
    unsigned gone = GoneAt(jettison_s, ignition_s + since);
    if (plant.boosters && since > plant.boosters->burn.duration_s + plant.boosters->separation_delay_s)
      gone |= kBoostersGone;
    const MassProperties mass = MassesOn(plant, index, gone, stack.burn.Propellant(since), since);
    const double level = stack.burn.curve ? std::max(stack.burn.Fraction(since), kLeastThrustFraction) : 1.0;
    const double thrust = stack.burn.vacuum_thrust_n * level;
    const double lever = stack.gimbal.pivot_station_m - mass.cg_station_m;
    if (since < boost_s) {
      const Vector2 moment = BoostedMoments(plant, thrust, lever, mass.cg_station_m, since);
      control.pitch_effectiveness_1_s2.x.push_back(since);
      control.roll_effectiveness_1_s2.x.push_back(since);
      control.roll_effectiveness_1_s2.y.push_back(
          plant.boosters->layout.rolls ? moment.x() / mass.axial_inertia_kg_m2 : 1.0);
      control.pitch_effectiveness_1_s2.y.push_back(moment.y() / mass.transverse_inertia_kg_m2);
      continue;
    }
    control.pitch_effectiveness_1_s2.x.push_back(since);
    control.roll_effectiveness_1_s2.x.push_back(since);
    // Of a cross two of the four nozzles turn in pitch (the paper's 2P), all four in roll.
    const bool is_cross = stack.gimbal.nozzles.empty();
    const double share = is_cross ? 0.5 : stack.layout.pitch_share;
    const double arm_m = is_cross ? stack.gimbal.radius_m : stack.layout.roll_arm_m;
    control.pitch_effectiveness_1_s2.y.push_back(share * thrust * lever / mass.transverse_inertia_kg_m2);
    // Commands of roll that nothing carries out may be any number.
    control.roll_effectiveness_1_s2.y.push_back(stack.layout.rolls ? thrust * arm_m / mass.axial_inertia_kg_m2
                                                                   : 1.0);
  }
  return control;
}

namespace {

ReferenceRows TabulateReference(const AttitudeProgram& program, const LaunchFrame& frame, double tick_s) {
  // Up to the first tick after the last knot, from which on the attitude is held.
  const long last = static_cast<long>(program.knots.back().time_s / tick_s) + 1;
  ReferenceRows table;
  table.last_tick = static_cast<double>(last);
  table.rows.reserve(static_cast<std::size_t>(last + 1) * ReferenceRows::kRowSize);
  for (long tick = 0; tick <= last; ++tick) {
    const ReferenceAttitude at = program.At(static_cast<double>(tick) * tick_s);
    const Quaternion q_IR = frame.q_IL * at.q_LR;
    table.rows.insert(table.rows.end(),
                      {q_IR.w, q_IR.x, q_IR.y, q_IR.z, at.w_LR_R.x(), at.w_LR_R.y(), at.w_LR_R.z(), 0.0});
  }
  return table;
}

FeedForwardRows TabulateFeedForward(const AttitudeProgram& program, const AutopilotConfig& autopilot,
                                    long ticks) {
  FeedForwardRows table;
  const std::optional<FeedForward>* const axes[kAxes] = {
      &autopilot.roll.feed_forward, &autopilot.pitch.feed_forward, &autopilot.yaw.feed_forward};
  if (!*axes[kRoll] && !*axes[kPitch] && !*axes[kYaw]) return table;
  table.rows.resize(static_cast<std::size_t>(ticks) * FeedForwardRows::kRowSize);
  for (int axis = 0; axis < kAxes; ++axis) {
    if (!*axes[axis]) continue;
    for (long tick = 0; tick < ticks; ++tick) {
      const double from_s = static_cast<double>(tick) * autopilot.tick_s + (*axes[axis])->lead_s;
      const double to_s = from_s + autopilot.tick_s;
      // The rate ends with the program: no acceleration stands for that.
      if (to_s > program.knots.back().time_s) break;
      table
          .rows[static_cast<std::size_t>(tick) * FeedForwardRows::kRowSize + static_cast<std::size_t>(axis)] =
          (program.At(to_s).w_LR_R[axis] - program.At(from_s).w_LR_R[axis]) / autopilot.tick_s;
    }
  }
  return table;
}

GuidanceLimits GuidanceLimitsOf(const FlightDefinition& definition) {
  return LimitsOf(definition.guidance,
                  AuthorityOf(definition.vehicle, definition.autopilot, definition.guidance));
}

GuidanceMission BuildMission(const FlightDefinition& definition, const LauncherPlant& plant,
                             const LaunchFrame& frame, const std::vector<StageTimes>& times) {
  // Fine enough that straight pieces stand for a program whose rates change by some 0.1 deg/s in a second.
  constexpr double kStep_s = 0.5;
  GuidanceMission mission;
  mission.config = definition.guidance;
  mission.limits = GuidanceLimitsOf(definition);
  mission.earth = plant.environment.earth;
  mission.air = plant.environment.air;
  mission.R_IL = frame.R_IL;
  const InjectionTarget& target = definition.target;
  mission.target = {target.altitude_m, target.velocity_m_s, target.flight_path_angle_rad,
                    target.inclination_rad};
  mission.orbit = target.orbit;
  mission.node_rad = target.node_rad;
  const std::size_t last = plant.stacks.size() - 1;
  const auto stage = [&](std::size_t i) {
    const LauncherStack& stack = plant.stacks[i];
    const double from_s = times[i].ignition_s, to_s = times[i].burnout_s;
    GuidedStage guided;
    guided.burn = stack.burn;
    for (std::size_t above = i; above < plant.stacks.size(); ++above)
      guided.cross_section_m2 =
          std::max(guided.cross_section_m2, 0.25 * kPi * Square(definition.vehicle.stages[above].diameter_m));
    const Stage& of_vehicle = definition.vehicle.stages[i];
    const bool ends_in_flight = EndsInFlight(of_vehicle.motor);
    const bool runs_dry = of_vehicle.motor.cut_off == CutOff::kAtDepletion;
    if (of_vehicle.is_liquid() && (ends_in_flight || runs_dry)) {
      guided.levels.emplace(of_vehicle.motor.throttle);
      guided.runs_dry = runs_dry;
      guided.ends_by_time = of_vehicle.motor.cut_off == CutOff::kByGuidance;
      guided.usable_kg = stack.burn.propellant_mass_kg - of_vehicle.motor.residual_mass_kg;
    }
    // Guidance begins after the boosters. Bodies with a criterion are there until the flight computer lets go
    // of them.
    unsigned before = GoneAt(definition.jettison_s, from_s);
    if (i == 0 && plant.boosters) before |= kBoostersGone;
    for (std::size_t k = 0; k < definition.jettison_s.size(); ++k) {
      if (plant.jettisoned_masses[k].stage < static_cast<int>(i)) continue;
      const Jettison& body = plant.jettisons[k];
      const double mass_kg = plant.jettisoned_masses[k].mass_kg, leaves_s = definition.jettison_s[k];
      const bool is_in_burn = leaves_s > from_s && leaves_s <= to_s;
      guided.loses_mass |= is_in_burn;
      if (body.trigger != JettisonTrigger::kAtTime) {
        before &= ~(1u << k);
        guided.drops.push_back({HUGE_VAL, mass_kg, body.trigger, body.threshold, 1u << k});
      } else if (is_in_burn || (guided.is_engine() && leaves_s > from_s && leaves_s < HUGE_VAL)) {
        guided.drops.push_back({leaves_s, mass_kg});
      } else {
        continue;
      }
      if (!guided.is_cut_off() && leaves_s <= 0.5 * (from_s + to_s)) guided.early_kg += mass_kg;
    }
    guided.ignition_mass_kg =
        MassOf(plant, static_cast<int>(i), before).fixed_mass_kg + stack.burn.propellant_mass_kg;
    return guided;
  };
  const auto start_of = [&](std::size_t i) {
    return BurnStart{definition.vehicle.stages[i].ignition == IgnitionTrigger::kTimer, times[i].ignition_s,
                     i > 0 ? times[i].ignition_s - times[i - 1].burnout_s : 0.0,
                     definition.vehicle.stages[i].restarts};
  };
  for (std::size_t i = FirstGuided(definition.vehicle, definition.guidance); i + 1 < last; ++i)
    mission.earlier.push_back({stage(i), start_of(i)});
  mission.below_start = start_of(last - 1);
  mission.below = stage(last - 1);
  mission.last = stage(last);
  mission.steers_below = SteersBelow(definition.vehicle, definition.guidance);
  mission.moves_ignition = definition.vehicle.stages.back().ignition == IgnitionTrigger::kTimer;
  mission.holds_last = !definition.vehicle.stages.back().is_controlled();
  mission.is_restart = definition.vehicle.stages.back().restarts;
  mission.below_burnout_s = times[last - 1].burnout_s;
  mission.last_ignition_s = mission.moves_ignition ? definition.last_ignition_s : times[last].ignition_s;
  mission.velocity_reserve_m_s = definition.velocity_reserve_m_s;
  mission.air_below_m = kAirBelow_m;
  mission.coast_air_below_m = kCoastAirBelow_m;
  mission.program.step_s = kStep_s;
  for (double time_s = 0.0; time_s <= definition.program.knots.back().time_s + kStep_s; time_s += kStep_s) {
    const PitchYawRoll at = definition.program.At(time_s).angles;
    mission.program.at.push_back({at.pitch, at.yaw});
  }
  return mission;
}

}  // namespace

namespace {

// Guidance computes how long an engine with a timer burns. What the file says then is only the time of the
// reference, and of a flight without a plan.
FlightDefinition WithGuidedTimers(FlightDefinition definition) {
  if (!definition.guidance.closed_loop || definition.vehicle.stages.empty()) return definition;
  // A last burn that uses up what the ones before leave does not bear another duration of theirs.
  const Stage& last = definition.vehicle.stages.back();
  if (last.restarts && !IsCutOffByGuidance(last)) return definition;
  for (std::size_t i = FirstGuided(definition.vehicle, definition.guidance);
       i < definition.vehicle.stages.size(); ++i) {
    Motor& motor = definition.vehicle.stages[i].motor;
    if (!definition.vehicle.stages[i].is_liquid() || motor.cut_off != CutOff::kAtTime) continue;
    motor.cut_off = CutOff::kByGuidance;
    definition.cut_off_s[i] = motor.cut_off_s;
  }
  return definition;
}

}  // namespace

FlightModel::FlightModel(FlightDefinition definition)
    : definition_(WithGuidedTimers(std::move(definition))), nominal_(BuildNominalPlant(definition_.vehicle)) {
  SpreadOut(definition_.vehicle.boosters);
  // Completed once: cases may draw them.
  if (!definition_.vehicle.aerodynamics.empty())
    definition_.vehicle.aerodynamics = AerodynamicsOf(definition_.vehicle);
  frame_ = BuildLaunchFrame(nominal_.environment.earth, definition_.vehicle.site,
                            definition_.program.launch_azimuth_rad);
  if (!definition_.own_metrics.empty())
    own_metrics_ = std::make_shared<const OwnMetricsPlan>(definition_.own_metrics);
  for (const Stage& stage : definition_.vehicle.stages) {
    has_free_stage_ |= !stage.is_controlled();
    has_fins_ |= !stage.fins.empty();
  }
  AddBending(definition_.vehicle, definition_.autopilot.tick_s, nominal_);
  const auto air_of = [](const WeatherTable& table) {
    return table.has_air() ? std::make_shared<const AirTable>(MeasuredAir(table)) : nullptr;
  };
  if (definition_.wind_table) {
    nominal_.environment.wind.tables.push_back(*definition_.wind_table);
    nominal_.environment.air = air_of(*definition_.wind_table);
  }
  for (const WeatherTable& sounding : definition_.soundings) airs_.push_back(air_of(sounding));
  LauncherPlant planned = nominal_;
  for (std::size_t i = 0; i < planned.stacks.size(); ++i)
    if (EndsInFlight(definition_.vehicle.stages[i].motor)) {
      // At once: a flight's own decay comes at another time, and must not raise the commands of others.
      CutOffAt(definition_.cut_off_s[i], planned.stacks[i].burn);
      PassOnPropellant(definition_.vehicle, i, planned);
    }
  LeaveForRestart(definition_, planned);
  std::vector<MotorBurn> burns;
  for (const LauncherStack& stack : planned.stacks) burns.push_back(stack.burn);
  const std::vector<StageTimes> times =
      BuildTimeline(definition_.vehicle, burns, definition_.autopilot.tick_s, definition_.last_ignition_s,
                    definition_.earlier_ignition_s);
  std::vector<StageControl> controls;
  for (std::size_t i = 0; i < times.size(); ++i)
    controls.push_back(
        BuildStageControl(planned, static_cast<int>(i), times[i].ignition_s, definition_.jettison_s));
  autopilot_ = BuildAutopilot(definition_.autopilot, std::move(controls),
                              definition_.vehicle.reaction_control.minimum_on_time_s);
  sensors_ = BuildSensors(definition_.vehicle, definition_.autopilot);
  reference_rows_ = TabulateReference(definition_.program, frame_, definition_.autopilot.tick_s);
  feed_forward_rows_ = TabulateFeedForward(definition_.program, definition_.autopilot,
                                           static_cast<long>(reference_rows_.last_tick) + 1);
  if (definition_.guidance.closed_loop) guidance_mission_ = BuildMission(definition_, planned, frame_, times);
}

FlightModel FlightModel::WithAutopilot(const AutopilotConfig& autopilot) const {
  DISPERSA_ASSERT(autopilot.tick_s == definition_.autopilot.tick_s);
  FlightModel model = *this;
  model.definition_.autopilot = autopilot;
  model.sensors_ = BuildSensors(definition_.vehicle, autopilot);
  model.autopilot_ =
      BuildAutopilot(autopilot, autopilot_.stages, definition_.vehicle.reaction_control.minimum_on_time_s);
  model.feed_forward_rows_ =
      TabulateFeedForward(definition_.program, autopilot, static_cast<long>(reference_rows_.last_tick) + 1);
  if (model.guidance_mission_) model.guidance_mission_->limits = GuidanceLimitsOf(model.definition_);
  return model;
}

namespace {

// A departure from the axis: towards body y, and towards body z.
struct Aside {
  double y = 0.0, z = 0.0;
};
// `factor`: of the magnitude and of the components.
Aside AsideOf(const Lateral& of, double factor = 1.0) {
  const SinCos c = SineCosine(of.clock_rad);
  const double magnitude = factor * of.magnitude;
  Aside aside{magnitude * c.cos, magnitude * c.sin};
  if (of.y != 0.0) aside.y += factor * of.y;
  if (of.z != 0.0) aside.z += factor * of.z;
  return aside;
}

// The spin for each metre of way that a stack's fins ask for: of all strips together no roll moment.
double TwistOf(const Vehicle& vehicle, std::size_t stack, const FlightInputs& in) {
  double wanted_m3 = 0.0, damped_m4 = 0.0;
  for (std::size_t i = stack; i < vehicle.stages.size();
       i = static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(i))) + 1) {
    std::size_t first = i;  // burn of the stage, whose draws are the stage's
    while (vehicle.stages[first].restarts) --first;
    for (const FinSet& fins : vehicle.stages[i].fins) {
      const FinStrips strips = StripsOf(fins, 0.5 * vehicle.stages[i].diameter_m);
      wanted_m3 += fins.count * (fins.cant_rad + in.stages[first].fin_cant_rad) * strips.first_m3;
      damped_m4 += fins.count * strips.second_m4;
    }
  }
  return damped_m4 > 0.0 ? wanted_m3 / damped_m4 : 0.0;
}

// Turns the thrust by the angles of `tilt`.
Matrix3 ThrustTilt(const Aside& tilt) {
  return RotationMatrix(FromRotationVector(Vector3(0.0, -tilt.z, tilt.y)));
}

NozzleDeparture DepartureOf(const NozzleInputs& nozzle) {
  const Aside moved = AsideOf(nozzle.line.offset_m);
  return {ThrustTilt(AsideOf(nozzle.line.misalignment_rad)), nozzle.thrust_factor, moved.y, moved.z};
}

// Of a stage's flow, by those of its nozzles. `further`: place of its first nozzle beyond four.
double FlowFactor(const NozzleLayout& layout, const FlightInputs& in, std::size_t stage,
                  std::size_t further) {
  double more = 0.0;
  for (int nozzle = 0; nozzle < layout.nozzles; ++nozzle) {
    const std::size_t k = static_cast<std::size_t>(nozzle);
    const double factor = nozzle < kNozzles ? in.stages[stage].nozzles[k].flow_factor
                                            : in.further[further + k - kNozzles].nozzle.flow_factor;
    more += layout.share[nozzle] * (factor - 1.0);
  }
  return 1.0 + more;
}

WindTable ProfileOf(const FlightInputs& in, int levels) {
  const auto first = [levels](const std::array<double, kWindLevels>& values) {
    return std::vector<double>(values.begin(), values.begin() + levels);
  };
  return {first(in.air.wind_profile_altitude_m), first(in.air.wind_profile_north_m_s),
          first(in.air.wind_profile_east_m_s)};
}

TurbulenceField TurbulenceOf(const FlightInputs& in, const TurbulencePath& path, std::uint64_t seed,
                             std::uint64_t case_index) {
  Stream along(seed, case_index, "turbulence/along"), across(seed, case_index, "turbulence/across"),
      normal(seed, case_index, "turbulence/normal");
  return DrawTurbulence(
      {in.air.turbulence_exceedance, in.air.turbulence_wind_20ft_m_s, in.air.turbulence_scale}, path,
      {[&] { return along.Normal(); }, [&] { return across.Normal(); }, [&] { return normal.Normal(); }});
}

// Those of one flight. Differences of each are inputs of nozzles after those of all stages. `boosters`: their
// mean, of the vehicle with the flight's masses.
std::shared_ptr<const BoosterSet> BoostersFor(const Vehicle& vehicle, const Boosters& boosters,
                                              const FlightInputs& in, double thrust_factor,
                                              const BoosterSet& nominal) {
  BoosterSet set = BuildBoosterSet(boosters, thrust_factor, in.stages[0].mass_flow_factor);
  set.layout = nominal.layout;
  set.gimbal.bandwidth_rad_s *= in.actuator_bandwidth_factor * in.stages[0].actuator_bandwidth_factor;
  std::size_t k = static_cast<std::size_t>(FurtherNozzlesBefore(vehicle, vehicle.stages.size()));
  for (std::size_t i = 0; i < boosters.angles_rad.size(); ++i, ++k) {
    const NozzleInputs& nozzle = in.further[k].nozzle;
    set.each.push_back(BuildEachBooster(
        BoosterOf(vehicle, in, i), i, thrust_factor, in.stages[0].mass_flow_factor,
        {nozzle.thrust_factor, nozzle.flow_factor, ThrustTilt(AsideOf(nozzle.line.misalignment_rad))}));
  }
  return std::make_shared<const BoosterSet>(std::move(set));
}

}  // namespace

FlightInputs FlightModel::AsApplied(FlightInputs in) const {
  const auto& statistics = definition_.wind_statistics;
  if (!statistics || WindLevelsOf(in.air.wind_profile_altitude_m) > 0) return in;
  const auto fill = [](const std::vector<double>& from, std::array<double, kWindLevels>& to) {
    std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
  };
  fill(statistics->altitude_m, in.air.wind_profile_altitude_m);
  fill(statistics->mean_north_m_s, in.air.wind_profile_north_m_s);
  fill(statistics->mean_east_m_s, in.air.wind_profile_east_m_s);
  return in;
}

LauncherPlant FlightModel::PlantFor(const FlightInputs& inputs,
                                    std::optional<std::uint64_t> case_index) const {
  const FlightInputs in = AsApplied(inputs);
  LauncherPlant plant = nominal_;
  plant.cg_factor = in.cg_factor;
  plant.inertia_factor = in.inertia_factor;
  plant.bending.frequency_factor = in.bending_frequency_factor;
  plant.bending.damping_factor = in.bending_damping_factor;
  plant.bending.slope_factor = in.bending_slope_factor;
  plant.environment.density.scale *= in.air.density_factor;

  Wind& wind = plant.environment.wind;
  if (const auto number = static_cast<std::size_t>(in.air.weather_sounding);
      number > 0 && number <= airs_.size()) {
    wind.tables.assign(1, definition_.soundings[number - 1]);
    plant.environment.air = airs_[number - 1];
  }
  if (in.air.wind_max_speed_m_s != 0.0)
    wind.jets.push_back(
        {in.air.wind_max_speed_m_s, in.air.wind_altitude_m, in.air.wind_width_m, in.air.wind_azimuth_rad});
  if (in.air.gust_speed_m_s != 0.0)
    wind.gusts.push_back(
        {in.air.gust_speed_m_s, in.air.gust_altitude_m, in.air.gust_length_m, in.air.gust_azimuth_rad});
  if (const int levels = WindLevelsOf(in.air.wind_profile_altitude_m); levels > 0)
    wind.tables.push_back(ProfileOf(in, levels));

  if (case_index && definition_.turbulence_path && in.air.turbulence_exceedance > 0.0)
    plant.environment.turbulence = std::make_shared<const TurbulenceField>(
        TurbulenceOf(in, *definition_.turbulence_path, definition_.noise_seed, *case_index));

  std::shared_ptr<const Vehicle> dispersed;
  if (ChangesMasses(in)) {
    dispersed = std::make_shared<const Vehicle>(WithDispersedMasses(definition_.vehicle, in));
    SetMasses(dispersed, plant);
  }
  const Vehicle& vehicle = dispersed ? *dispersed : definition_.vehicle;

  std::size_t further = 0;  // of the nozzles beyond four of a stage, through the vehicle
  const AeroSigmas sigmas{in.table_ca_sigmas, in.table_cn_sigmas, in.table_xcp_sigmas,
                          in.table_damping_sigmas};
  for (std::size_t i = 0; i < plant.stacks.size(); ++i) {
    LauncherStack& stack = plant.stacks[i];
    if (!sigmas.is_nominal() && i < vehicle.aerodynamics.size() && IsUncertain(vehicle.aerodynamics[i]))
      SetAerodynamics(vehicle, Drawn(vehicle.aerodynamics[i], sigmas), stack);
    const StageInputs& of = in.stages[i];
    const double thrust_factor = of.thrust_factor * of.specific_impulse_factor;
    const double flow_factor = of.mass_flow_factor * FlowFactor(stack.layout, in, i, further);
    stack.burn = dispersed ? BuildBurn(vehicle.stages[i], thrust_factor, flow_factor)
                           : BuildBurn(vehicle.stages[i], thrust_factor, flow_factor, stack.burn.curve);
    if (of.tail_off_factor != 1.0) SetTailOff(of.tail_off_factor, vehicle.stages[i], stack.burn);
    if (i == 0 && plant.boosters)
      plant.boosters = BoostersFor(definition_.vehicle, vehicle.boosters, in, thrust_factor, *plant.boosters);
    stack.gimbal.bandwidth_rad_s *= in.actuator_bandwidth_factor * of.actuator_bandwidth_factor;
    stack.aerodynamics.ca.factor = in.drag_factor * of.drag_factor;
    stack.aerodynamics.cn.factor = in.lift_factor * of.lift_factor;
    stack.aerodynamics.xcp_station_m.factor = in.cp_factor * of.cp_factor;
    if (has_fins_) stack.aerodynamics.twist_rad_m = TwistOf(vehicle, i, in);
    stack.cg_factor = of.cg_factor;
    stack.inertia_factor = of.inertia_factor;
    stack.product_xy_kg_m2 = of.product_of_inertia_xy_kg_m2;
    stack.product_xz_kg_m2 = of.product_of_inertia_xz_kg_m2;
    stack.product_yz_kg_m2 = of.product_of_inertia_yz_kg_m2;
    stack.thrust_tilt = ThrustTilt(AsideOf(of.thrust.misalignment_rad));
    const Aside offset = AsideOf(of.thrust.offset_m);
    stack.thrust_offset_y_m = offset.y;
    stack.thrust_offset_z_m = offset.z;
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle)
      stack.nozzles[nozzle] = DepartureOf(of.nozzles[nozzle]);
    for (int nozzle = kNozzles; nozzle < stack.layout.nozzles; ++nozzle, ++further)
      stack.nozzles[static_cast<std::size_t>(nozzle)] = DepartureOf(in.further[further].nozzle);
    const Aside lateral = AsideOf(of.cg_offset_m, stack.mass.fixed_mass_kg);
    stack.lateral_moment_y_kg_m = lateral.y;
    stack.lateral_moment_z_kg_m = lateral.z;
  }
  for (std::size_t i = 0; i < plant.stacks.size(); ++i)
    if (!vehicle.stages[i].restarts) PassOnPropellant(vehicle, i, plant);
  return plant;
}

}  // namespace dispersa
