#include "core/dynamics/launcher.h"

#include "core/math/functions.h"

namespace dispersa {

namespace {

double Deflection(const double* y, int nozzle) { return y[kNozzleAngle + nozzle]; }

// Adds the thrust of the four nozzles. `lever_m` is the distance from the CG aft to the pivots.
void AddThrust(const LauncherStack& stack, const double* y, double thrust_n, double lever_m,
               BodyLoads& loads) {
  const double r = stack.gimbal.radius_m;
  const double quarter = 0.25 * thrust_n;
  // Hinge geometry of the nozzles right (+y), left (-y), bottom (+z), top (-z): position across the axis,
  // and the direction in which a positive deflection turns the force.
  constexpr double kPositionY[kNozzles] = {1.0, -1.0, 0.0, 0.0};
  constexpr double kPositionZ[kNozzles] = {0.0, 0.0, 1.0, -1.0};
  constexpr double kTurnY[kNozzles] = {0.0, 0.0, -1.0, -1.0};
  constexpr double kTurnZ[kNozzles] = {1.0, 1.0, 0.0, 0.0};
  for (int i = 0; i < kNozzles; ++i) {
    const SinCos turn = SineCosine(Deflection(y, i));
    const Vector3 force =
        stack.thrust_tilt * Vector3(quarter * turn.cos, quarter * turn.sin * kTurnY[i],
                                    quarter * turn.sin * kTurnZ[i]);
    const Vector3 arm(-lever_m, r * kPositionY[i] + stack.thrust_offset_y_m,
                      r * kPositionZ[i] + stack.thrust_offset_z_m);
    loads.force_n += force;
    loads.moment_n_m += arm.cross(force);
  }
}

}  // namespace

RigidBodyState AfterSeparation(const LauncherPlant& plant, int below, const RigidBodyState& state) {
  const StackMass& whole = plant.stacks[static_cast<std::size_t>(below)].mass;
  const StackMass& upper = plant.stacks[static_cast<std::size_t>(below) + 1].mass;
  const double old_cg = whole.At(0.0).cg_station_m * plant.cg_factor;
  const double new_cg = upper.At(upper.propellant_mass_kg).cg_station_m * plant.cg_factor;
  return AtPoint(state, Vector3(old_cg - new_cg, 0.0, 0.0));
}

LauncherInstant Evaluate(const LauncherPlant& plant, const LauncherPhase& phase, double time_s,
                         const double* y) {
  const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(phase.stack)];
  const RigidBodyState state = ReadState(y);
  LauncherInstant now;
  now.air = ComputeAirData(plant.environment, state.p_EoC_I, state.v_IC_I);

  double propellant = phase.burnt ? 0.0 : stack.burn.propellant_mass_kg;
  double fraction = 0.0;
  if (phase.burning) {
    // Held within the burn, so that the ends of the last step, which rounding may put outside, count.
    const double since = Clamp(time_s - phase.ignition_s, 0.0, stack.burn.duration_s);
    propellant = stack.burn.Propellant(since);
    fraction = stack.burn.Fraction(since);
  }
  MassProperties mass = stack.mass.At(propellant);
  mass.cg_station_m *= plant.cg_factor;
  now.cg_station_m = mass.cg_station_m;
  now.loads.mass_kg = mass.mass_kg - phase.expelled_mass_kg;
  const double axial = mass.axial_inertia_kg_m2 * plant.inertia_factor;
  const double transverse = mass.transverse_inertia_kg_m2 * plant.inertia_factor;
  now.loads.inertia_kg_m2 = Vector3(axial, transverse, transverse).asDiagonal();

  const Matrix3 R_IB = RotationMatrix(state.q_IB);
  now.v_AB_B = R_IB.transpose() * now.air.v_AP_I;
  const Vector3 earth_rate_I(0.0, 0.0, plant.environment.earth.rotation_rate_rad_s);
  const Vector3 w_EB_B = state.w_IB_B - R_IB.transpose() * earth_rate_I;
  const ForceAndMoment air = AerodynamicForce(stack.aerodynamics, now.v_AB_B, w_EB_B, now.air.mach,
                                              now.air.qbar_pa, now.cg_station_m);
  now.loads.force_n = air.force_n;
  now.loads.moment_n_m = air.moment_n_m + phase.control_torque_n_m;

  if (phase.burning) {
    // P = P_vac - p A_e; a nozzle that the ambient pressure would turn inwards gives nothing.
    const double pressure_loss = now.air.pressure_pa * stack.burn.exit_area_m2;
    const double vacuum = stack.burn.vacuum_thrust_n * fraction;
    now.thrust_n = vacuum < pressure_loss ? 0.0 : vacuum - pressure_loss;
    now.flow_kg_s = stack.burn.full_flow_kg_s * fraction;
    const double lever = stack.gimbal.pivot_station_m - now.cg_station_m;
    AddThrust(stack, y, now.thrust_n, lever, now.loads);
    const double axial_rate = -now.flow_kg_s * mass.axial_inertia_per_kg * plant.inertia_factor;
    const double transverse_rate =
        -now.flow_kg_s * mass.transverse_inertia_per_kg * plant.inertia_factor;
    now.loads.inertia_rate_kg_m2_s = Vector3(axial_rate, transverse_rate, transverse_rate).asDiagonal();
    if (plant.jet_damping) {
      // The flow leaves with the velocity of the nozzle about the CG: -m_dot r x (w x r), r on the axis,
      // and for roll the nozzle circle's radius.
      const double across = now.flow_kg_s * Square(lever);
      const double about = now.flow_kg_s * Square(stack.gimbal.radius_m);
      now.loads.moment_n_m -=
          Vector3(about * state.w_IB_B.x(), across * state.w_IB_B.y(), across * state.w_IB_B.z());
    }
  }
  return now;
}

void LauncherDerivative(const LauncherPlant& plant, const LauncherPhase& phase, double time_s,
                        const double* y, double* dydt) {
  const LauncherInstant now = Evaluate(plant, phase, time_s, y);
  RigidBodyDerivative(plant.environment.earth, ReadState(y), now.loads, dydt);

  const Gimbal& gimbal = plant.stacks[static_cast<std::size_t>(phase.stack)].gimbal;
  const double w = gimbal.bandwidth_rad_s;
  for (int i = 0; i < kNozzles; ++i) {
    double& angle_rate = dydt[kNozzleAngle + i];
    double& rate_rate = dydt[kNozzleRate + i];
    if (i == phase.stuck_nozzle) {
      angle_rate = rate_rate = 0.0;
      continue;
    }
    const double command = Clamp(phase.command_rad[static_cast<std::size_t>(i)], -gimbal.limit_rad,
                                 gimbal.limit_rad);
    const double rate = y[kNozzleRate + i];
    angle_rate = Clamp(rate, -gimbal.rate_limit_rad_s, gimbal.rate_limit_rad_s);
    rate_rate = w * (w * (command - y[kNozzleAngle + i]) - 2.0 * gimbal.damping_ratio * rate);
    // At the rate limit the drive cannot accelerate further outwards.
    if ((rate >= gimbal.rate_limit_rad_s && rate_rate > 0.0) ||
        (rate <= -gimbal.rate_limit_rad_s && rate_rate < 0.0))
      rate_rate = 0.0;
  }
}

}  // namespace dispersa
