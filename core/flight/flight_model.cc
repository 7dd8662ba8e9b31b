#include "core/flight/flight_model.h"

#include <cassert>

#include "core/dynamics/aero_grid.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/random/draws.h"
#include "core/vehicle/aerodynamics_build_up.h"

namespace dispersa {

LauncherPlant BuildNominalPlant(const Vehicle& vehicle) {
  LauncherPlant plant;
  plant.jet_damping = vehicle.jet_damping;
  plant.flow_coriolis = vehicle.flow_coriolis;
  const std::vector<StackMass> masses = BuildStackMasses(vehicle);
  const std::vector<AeroTable> tables =
      vehicle.aerodynamics.empty() ? BuildAerodynamics(vehicle) : vehicle.aerodynamics;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    LauncherStack stack;
    stack.mass = masses[i];
    stack.aerodynamics = FromTable(tables[i]);
    stack.aero_grid = std::make_shared<const AeroGrid>(BuildAeroGrid(stack.aerodynamics));
    stack.burn = BuildBurn(stage, 1.0, 1.0);
    stack.gimbal = stage.gimbal;
    stack.layout = BuildNozzleLayout(stage.gimbal);
    if (!vehicle.profile.empty())
      stack.loads = std::make_shared<const LoadTable>(BuildLoadTable(vehicle, static_cast<int>(i)));
    plant.stacks.push_back(stack);
  }
  return plant;
}

void AddBending(const Vehicle& vehicle, double tick_s, LauncherPlant& plant) {
  if (!vehicle.structure_beam || vehicle.structure_beam->flown_modes == 0) return;
  plant.bending.damping_ratio = vehicle.structure_beam->damping_ratio;
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  for (std::size_t i = 0; i < stacks.size(); ++i)
    plant.stacks[i].bending =
        std::make_shared<const BendingTable>(BuildBendingTable(vehicle, stacks[i], *plant.stacks[i].loads, kPi / tick_s));
}

StageControl BuildStageControl(const LauncherStack& stack) {
  // The effectiveness changes slowly and smoothly: this many points follow it to a part in a thousand.
  constexpr int kPoints = 33;
  StageControl control;
  control.limit_rad = stack.gimbal.limit_rad;
  for (int i = 0; i < kPoints; ++i) {
    const double since = stack.burn.duration_s * i / (kPoints - 1);
    const MassProperties mass = stack.mass.At(stack.burn.Propellant(since));
    const double thrust = stack.burn.vacuum_thrust_n;
    const double lever = stack.gimbal.pivot_station_m - mass.cg_station_m;
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
    table.rows.insert(table.rows.end(), {q_IR.w, q_IR.x, q_IR.y, q_IR.z, at.w_LR_R.x(), at.w_LR_R.y(),
                                         at.w_LR_R.z(), 0.0});
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

GuidanceMission BuildMission(const FlightDefinition& definition, const LauncherPlant& plant,
                             const LaunchFrame& frame) {
  // Fine enough that straight pieces stand for a program whose rates change by some 0.1 deg/s in a second.
  constexpr double kStep_s = 0.5;
  GuidanceMission mission;
  mission.config = definition.guidance;
  mission.earth = plant.environment.earth;
  mission.R_IL = frame.R_IL;
  const InjectionTarget& target = definition.target;
  mission.target = {target.altitude_m, target.velocity_m_s, target.flight_path_angle_rad,
                    target.inclination_rad};
  const auto stage = [&](std::size_t i) {
    const LauncherStack& stack = plant.stacks[i];
    return GuidedStage{stack.burn, stack.mass.fixed_mass_kg + stack.burn.propellant_mass_kg};
  };
  const std::size_t last = plant.stacks.size() - 1;
  mission.below = stage(last - 1);
  mission.last = stage(last);
  mission.last_ignition_s = definition.last_ignition_s;
  mission.velocity_reserve_m_s = definition.velocity_reserve_m_s;
  mission.program.step_s = kStep_s;
  for (double time_s = 0.0; time_s <= definition.program.knots.back().time_s + kStep_s; time_s += kStep_s) {
    const PitchYawRoll at = definition.program.At(time_s).angles;
    mission.program.at.push_back({at.pitch, at.yaw});
  }
  return mission;
}

}  // namespace

FlightModel::FlightModel(FlightDefinition definition)
    : definition_(std::move(definition)),
      nominal_(BuildNominalPlant(definition_.vehicle)) {
  frame_ = BuildLaunchFrame(nominal_.environment.earth, definition_.vehicle.site,
                            definition_.program.launch_azimuth_rad);
  AddBending(definition_.vehicle, definition_.autopilot.tick_s, nominal_);
  if (definition_.wind_table) nominal_.environment.wind.tables.push_back(*definition_.wind_table);
  std::vector<StageControl> controls;
  for (const LauncherStack& stack : nominal_.stacks) controls.push_back(BuildStageControl(stack));
  autopilot_ = BuildAutopilot(definition_.autopilot, std::move(controls),
                              definition_.vehicle.reaction_control.minimum_on_time_s);
  sensors_ = BuildSensors(definition_.vehicle, definition_.autopilot);
  reference_rows_ = TabulateReference(definition_.program, frame_, definition_.autopilot.tick_s);
  feed_forward_rows_ = TabulateFeedForward(definition_.program, definition_.autopilot,
                                           static_cast<long>(reference_rows_.last_tick) + 1);
  if (definition_.guidance.closed_loop)
    guidance_mission_ = BuildMission(definition_, nominal_, frame_);
}

FlightModel FlightModel::WithAutopilot(const AutopilotConfig& autopilot) const {
  assert(autopilot.tick_s == definition_.autopilot.tick_s);
  FlightModel model = *this;
  model.definition_.autopilot = autopilot;
  model.sensors_ = BuildSensors(definition_.vehicle, autopilot);
  model.autopilot_ =
      BuildAutopilot(autopilot, autopilot_.stages, definition_.vehicle.reaction_control.minimum_on_time_s);
  model.feed_forward_rows_ =
      TabulateFeedForward(definition_.program, autopilot, static_cast<long>(reference_rows_.last_tick) + 1);
  return model;
}

namespace {

// Turns the thrust by `tilt` towards the direction `clock` (from body y towards body z).
Matrix3 ThrustTilt(double tilt, double clock) {
  const SinCos c = SineCosine(clock);
  return RotationMatrix(FromRotationVector(Vector3(0.0, -tilt * c.sin, tilt * c.cos)));
}

WindTable DrawnProfile(const WindStatistics& statistics, const FlightInputs& inputs) {
  std::vector<double> normals;
  for (std::size_t level = 0; level < statistics.altitude_m.size(); ++level) {
    normals.push_back(inputs.wind_profile_north[level]);
    normals.push_back(inputs.wind_profile_east[level]);
  }
  return DrawWind(statistics, normals);
}

TurbulenceField TurbulenceOf(const FlightInputs& in, const TurbulencePath& path, std::uint64_t seed,
                             std::uint64_t case_index) {
  Stream along(seed, case_index, "turbulence/along"), across(seed, case_index, "turbulence/across"),
      normal(seed, case_index, "turbulence/normal");
  return DrawTurbulence(
      {in.turbulence_exceedance, in.turbulence_wind_20ft_m_s, in.turbulence_scale}, path,
      {[&] { return along.Normal(); }, [&] { return across.Normal(); }, [&] { return normal.Normal(); }});
}

}  // namespace

LauncherPlant FlightModel::PlantFor(const FlightInputs& in, std::optional<std::uint64_t> case_index) const {
  LauncherPlant plant = nominal_;
  plant.cg_factor = in.cg_factor;
  plant.inertia_factor = in.inertia_factor;
  plant.bending.frequency = in.bending_frequency_factor;
  plant.bending.damping_ratio *= in.bending_damping_factor;
  plant.bending.slope = in.bending_slope_factor;
  plant.environment.density.scale *= in.density_factor;

  Wind& wind = plant.environment.wind;
  if (in.wind_max_speed_m_s != 0.0)
    wind.jets.push_back(
        {in.wind_max_speed_m_s, in.wind_altitude_m, in.wind_width_m, in.wind_azimuth_rad});
  if (in.gust_speed_m_s != 0.0)
    wind.gusts.push_back(
        {in.gust_speed_m_s, in.gust_altitude_m, in.gust_length_m, in.gust_azimuth_rad});
  if (definition_.wind_statistics)
    wind.tables.push_back(DrawnProfile(*definition_.wind_statistics, in));

  if (case_index && definition_.turbulence_path && in.turbulence_exceedance > 0.0)
    plant.environment.turbulence = std::make_shared<const TurbulenceField>(
        TurbulenceOf(in, *definition_.turbulence_path, definition_.noise_seed, *case_index));

  for (std::size_t i = 0; i < plant.stacks.size(); ++i) {
    LauncherStack& stack = plant.stacks[i];
    const Stage& stage = definition_.vehicle.stages[i];
    stack.burn = BuildBurn(stage, in.thrust_factor[i] * in.specific_impulse_factor[i],
                           in.mass_flow_factor[i]);
    stack.gimbal.bandwidth_rad_s *= in.actuator_bandwidth_factor;
    stack.aerodynamics.ca.factor = in.drag_factor;
    stack.aerodynamics.cn.factor = in.lift_factor;
    stack.aerodynamics.xcp_station_m.factor = in.cp_factor;
    stack.thrust_tilt = ThrustTilt(in.thrust_misalignment_rad[i], in.thrust_misalignment_clock_rad[i]);
    const SinCos offset = SineCosine(in.thrust_offset_clock_rad[i]);
    stack.thrust_offset_y_m = in.thrust_offset_m[i] * offset.cos;
    stack.thrust_offset_z_m = in.thrust_offset_m[i] * offset.sin;
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle) {
      const SinCos at = SineCosine(in.nozzle_offset_clock_rad[i][nozzle]);
      stack.nozzles[nozzle] = {
          ThrustTilt(in.nozzle_misalignment_rad[i][nozzle], in.nozzle_misalignment_clock_rad[i][nozzle]),
          in.nozzle_thrust_factor[i][nozzle], in.nozzle_offset_m[i][nozzle] * at.cos,
          in.nozzle_offset_m[i][nozzle] * at.sin};
    }
    const SinCos aside = SineCosine(in.cg_offset_clock_rad[i]);
    stack.lateral_moment_y_kg_m = stack.mass.fixed_mass_kg * in.cg_offset_m[i] * aside.cos;
    stack.lateral_moment_z_kg_m = stack.mass.fixed_mass_kg * in.cg_offset_m[i] * aside.sin;
  }
  return plant;
}

}  // namespace dispersa
