#include "core/dynamics/launcher.h"

#include "core/dynamics/launcher_lanes.h"
#include "core/math/lane_eigen.h"

namespace dispersa {

namespace {

// One lane of the model, with what it points to.
class OneLane {
 public:
  OneLane(const LauncherPlant& plant, const LauncherPhase& phase, double time_s, const double* y)
      : motion{{y[0], y[1], y[2]}, {y[3], y[4], y[5]}, {y[6], y[7], y[8], y[9]}, {y[10], y[11], y[12]}},
        weather_(PrepareWeather(plant.environment.wind, plant.environment.density)) {
    const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(phase.stack)];
    grid_ = stack.aero_grid ? stack.aero_grid
                            : std::make_shared<const AeroGrid>(BuildAeroGrid(stack.aerodynamics));
    LauncherPlant one;  // the stack alone
    one.stacks = {stack};
    one.stacks.front().aero_grid = grid_;
    one.cg_factor = plant.cg_factor;
    one.inertia_factor = plant.inertia_factor;
    lanes::SetLane(plant_, 0, one, 0);
    lanes::SetLane(plant_.weather, 0, weather_);
    lanes::SetLane(drives, 0, stack.gimbal, phase.stuck_nozzle);
    phase_ = {phase.burning, phase.burnt, phase.ignition_s, phase.expelled_mass_kg,
              ToLanes(phase.control_torque_n_m)};
    around = lanes::SurroundingsAt(plant.environment.earth, StandardAir(), plant_.weather, motion.p);
    masses = lanes::MassesAt(plant_, phase_, time_s);
    nozzles = lanes::NozzlesAt(y + kNozzleAngle);
  }

  const lanes::Plant<double>& plant() const { return plant_; }
  const lanes::Phase<double>& phase() const { return phase_; }

  lanes::Drives<double> drives{};
  lanes::Motion<double> motion;
  lanes::Surroundings<double> around{};
  lanes::TimedMasses<double> masses{};
  lanes::Nozzles<double> nozzles{};

 private:
  FlightWeather weather_;
  std::shared_ptr<const AeroGrid> grid_;
  lanes::Plant<double> plant_{};
  lanes::Phase<double> phase_{};
};

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
  const OneLane one(plant, phase, time_s, y);
  const Earth& earth = plant.environment.earth;
  const lanes::Motion<double>& s = one.motion;
  const lanes::TimedMasses<double>& masses = one.masses;
  const lanes::LoadsOf<double> loads =
      lanes::LoadsAt(earth.rotation_rate_rad_s, plant.jet_damping, one.plant(), one.phase(), phase.burning,
                     one.around, masses, one.nozzles, s);
  LauncherInstant now;
  now.air.place = ToGeodetic(earth, Vector3(y[0], y[1], y[2]));
  now.air.v_AP_I = ToEigen(loads.v_air);
  now.air.airspeed_m_s = now.air.v_AP_I.norm();
  now.air.density_kg_m3 = one.around.density_kg_m3;
  now.air.pressure_pa = one.around.pressure_pa;
  now.air.mach = loads.flow.mach;
  now.air.qbar_pa = loads.flow.qbar_pa;
  now.v_AB_B = ToEigen(loads.v_AB_B);
  now.cg_station_m = masses.cg_station_m;
  now.thrust_n = loads.thrust_n;
  now.flow_kg_s = loads.flow_kg_s;
  now.loads.mass_kg = masses.mass_kg;
  now.loads.force_n = ToEigen(loads.force_n);
  now.loads.inertia_kg_m2 =
      Vector3(masses.axial_kg_m2, masses.transverse_kg_m2, masses.transverse_kg_m2).asDiagonal();
  now.loads.inertia_rate_kg_m2_s =
      -loads.flow_kg_s *
      Matrix3(Vector3(masses.axial_per_kg_m2, masses.transverse_per_kg_m2, masses.transverse_per_kg_m2)
                  .asDiagonal());
  now.loads.moment_n_m =
      ToEigen(loads.moment_n_m) -
      Vector3(loads.jet_axial * s.w.x, loads.jet_transverse * s.w.y, loads.jet_transverse * s.w.z);
  return now;
}

void LauncherDerivative(const LauncherPlant& plant, const LauncherPhase& phase, double time_s,
                        const double* y, double* dydt) {
  const OneLane one(plant, phase, time_s, y);
  const Earth& earth = plant.environment.earth;
  const lanes::Motion<double>& s = one.motion;
  const auto rates =
      lanes::RatesOf<double>(earth.rotation_rate_rad_s, plant.jet_damping, one.plant(), one.phase(),
                             phase.burning, one.around, one.masses, one.nozzles, s, nullptr);
  const Quaternion dq = Derivative({s.q.w, s.q.x, s.q.y, s.q.z}, ToEigen(s.w));
  WriteState({ToEigen(s.v), ToEigen(rates.dv), dq, ToEigen(rates.dw)}, dydt);
  for (int i = 0; i < kNozzles; ++i) {
    const double limit = one.drives.limit_rad;
    const double command = Clamp(phase.command_rad[static_cast<std::size_t>(i)], -limit, limit);
    lanes::DriveRates(one.drives, i, command, y[kNozzleAngle + i], y[kNozzleRate + i], dydt[kNozzleAngle + i],
                      dydt[kNozzleRate + i]);
  }
}

}  // namespace dispersa
