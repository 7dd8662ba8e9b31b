#include "core/flight/fly_scenario.h"

#include <array>
#include <cmath>

#include "core/dynamics/aero_grid.h"
#include "core/flight/history_columns.h"

namespace dispersa {

namespace {

// CVODE's absolute tolerances: m, m/s, quaternion, rad/s.
constexpr std::array<double, kRigidBodySize> kTolerances = {1e-6,  1e-6,  1e-6,  1e-9,  1e-9,  1e-9, 1e-13,
                                                            1e-13, 1e-13, 1e-13, 1e-13, 1e-13, 1e-13};

// A stretch of flight in which the right-hand side is smooth in time. Propellant and mass properties are
// linear in time: between two rows of the mass table at a constant flow.
struct Phase {
  double begin_s = 0.0;
  std::size_t stage = 0;
  bool burning = false;
  double propellant_kg = 0.0;  ///< at begin_s
  std::size_t row = 0;         ///< of the mass table, below the propellant
};

std::size_t FullRow(const ScenarioMass& mass) {
  return mass.propellant_kg.size() < 2 ? 0 : mass.propellant_kg.size() - 2;
}

// One stage from `begin_s`. The next stage's separation ends it.
void AppendPhases(const ScenarioStage& stage, std::size_t index, double begin_s, std::vector<Phase>& phases) {
  const std::vector<double>& propellant = stage.mass.propellant_kg;
  phases.push_back({begin_s, index, false, propellant.back(), FullRow(stage.mass)});
  if (!stage.motor) return;
  const ScenarioMotor& motor = *stage.motor;
  for (std::size_t row = propellant.size() - 1; row-- > 0;) {
    const double burnt_kg = propellant.back() - propellant[row + 1];
    phases.push_back(
        {motor.ignition_time_s + burnt_kg / motor.flow_kg_s, index, true, propellant[row + 1], row});
  }
  phases.push_back({motor.ignition_time_s + BurnTime(stage), index, false, 0.0, 0});
}

std::vector<Phase> PhasesOf(const Scenario& scenario) {
  std::vector<Phase> phases;
  double begin_s = 0.0;
  for (std::size_t i = 0; i < scenario.stages.size(); ++i) {
    while (!phases.empty() && phases.back().begin_s >= begin_s) phases.pop_back();
    AppendPhases(scenario.stages[i], i, begin_s, phases);
    if (i + 1 < scenario.stages.size()) begin_s = SeparationTime(scenario.stages[i]);
  }
  return phases;
}

struct Motion {
  const Scenario& scenario;
  Phase phase;
  std::vector<AeroGrid> grids;  ///< one a stage

  const ScenarioStage& stage() const { return scenario.stages[phase.stage]; }
  static void Rhs(double t, const double* y, double* dydt, void* context);
};

void SetMass(const ScenarioStage& stage, const Phase& phase, double time_s, BodyLoads& loads,
             double& cg_station_m) {
  const ScenarioMass& mass = stage.mass;
  loads.mass_kg = mass.mass_kg[phase.row];
  loads.inertia_kg_m2 = mass.inertia_kg_m2[phase.row];
  cg_station_m = mass.cg_station_m[phase.row];
  if (mass.propellant_kg.size() < 2) return;
  const double flow = phase.burning ? stage.motor->flow_kg_s : 0.0;
  const double propellant = phase.propellant_kg - flow * (time_s - phase.begin_s);
  const double step_kg = mass.propellant_kg[phase.row + 1] - mass.propellant_kg[phase.row];
  const double above_kg = propellant - mass.propellant_kg[phase.row];
  const double fraction = above_kg / step_kg;
  const Matrix3 change = mass.inertia_kg_m2[phase.row + 1] - mass.inertia_kg_m2[phase.row];
  // The table's masses may be rounded. The balance of thrust and flow needs mass and propellant to agree.
  loads.mass_kg = mass.mass_kg.front() + propellant;
  loads.inertia_kg_m2 += fraction * change;
  cg_station_m += fraction * (mass.cg_station_m[phase.row + 1] - mass.cg_station_m[phase.row]);
  if (phase.burning) loads.inertia_rate_kg_m2_s = (-flow / step_kg * stage.motor->inertia_rate) * change;
}

void AddThrust(const ScenarioMotor& motor, double pressure_pa, const Vector3& w_IB_B, double cg_station_m,
               ScenarioSample& now) {
  const double thrust = motor.thrust_n - pressure_pa * motor.nozzle_exit_area_m2;
  now.thrust_n = thrust > 0.0 ? thrust : 0.0;
  const Vector3 force(now.thrust_n, 0.0, 0.0);
  const Vector3 arm(cg_station_m - motor.nozzle_station_m, motor.nozzle_y_m, motor.nozzle_z_m);
  now.loads.force_n += force;
  now.loads.moment_n_m += arm.cross(force);
  if (motor.jet_damping) now.loads.moment_n_m -= motor.flow_kg_s * arm.cross(w_IB_B.cross(arm));
}

ScenarioSample Evaluate(const Motion& motion, double time_s, const double* y) {
  const ScenarioStage& stage = motion.stage();
  const Environment& environment = motion.scenario.environment;
  ScenarioSample now;
  now.time_s = time_s;
  now.stage = motion.phase.stage;
  now.state = ReadState(y);
  now.air = ComputeAirData(environment, now.state.p_EoC_I, now.state.v_IC_I);
  double cg_station_m = 0.0;
  SetMass(stage, motion.phase, time_s, now.loads, cg_station_m);

  const Matrix3 R_BI = RotationMatrix(now.state.q_IB).transpose();
  now.v_AB_B = R_BI * now.air.v_AP_I;
  Vector3 damped_rates = now.state.w_IB_B;
  if (!stage.inertial_damping_rates)
    damped_rates -= R_BI * Vector3(0.0, 0.0, environment.earth.rotation_rate_rad_s);
  now.aerodynamic =
      AerodynamicForce(stage.aerodynamics, motion.grids[motion.phase.stage], now.v_AB_B, damped_rates,
                       now.air.density_kg_m3, now.air.speed_of_sound_m_s, cg_station_m);
  now.loads.force_n = now.aerodynamic.force_n;
  now.loads.moment_n_m = now.aerodynamic.moment_n_m;
  if (motion.phase.burning) AddThrust(*stage.motor, now.air.pressure_pa, now.state.w_IB_B, cg_station_m, now);
  return now;
}

void Motion::Rhs(double t, const double* y, double* dydt, void* context) {
  const auto* self = static_cast<const Motion*>(context);
  const ScenarioSample now = Evaluate(*self, t, y);
  RigidBodyDerivative(self->scenario.environment.earth, now.state, now.loads, dydt);
}

// The state follows the CG, which jumps to that of the remaining stage.
void Separate(const Scenario& scenario, const Phase& from, const Phase& to, double time_s, double* y) {
  BodyLoads unused;
  double old_cg = 0.0;
  double new_cg = 0.0;
  SetMass(scenario.stages[from.stage], from, time_s, unused, old_cg);
  SetMass(scenario.stages[to.stage], to, time_s, unused, new_cg);
  WriteState(AtPoint(ReadState(y), Vector3(old_cg - new_cg, 0.0, 0.0)), y);
}

std::vector<AeroGrid> GridsOf(const Scenario& scenario) {
  std::vector<AeroGrid> grids;
  for (const ScenarioStage& stage : scenario.stages) grids.push_back(BuildAeroGrid(stage.aerodynamics));
  return grids;
}

class Flight {
 public:
  Flight(const Scenario& scenario, Scheme scheme)
      : scenario_(scenario),
        phases_(PhasesOf(scenario)),
        motion_{scenario, phases_.front(), GridsOf(scenario)},
        integrator_(scheme, kRigidBodySize, &Motion::Rhs, &motion_, kTolerances.data()) {
    WriteState(InitialState(scenario), y_.data());
  }

  ScenarioFlight Run() {
    bool flying = AdvanceTo(0.0);
    if (flying) AddSample();
    for (long i = 1; flying && time_s_ < scenario_.duration_s; ++i) {
      const double next_s = static_cast<double>(i) * scenario_.output_step_s;
      // A last step that only rounding keeps from the end is the end.
      const bool is_last = next_s > scenario_.duration_s - 1e-9 * scenario_.output_step_s;
      flying = AdvanceTo(is_last ? scenario_.duration_s : next_s);
      if (flying) AddSample();
    }
    flight_.end_time_s = time_s_;
    flight_.digest = digester_.Finish();
    return std::move(flight_);
  }

 private:
  bool AdvanceTo(double to_s) {
    while (next_phase_ < phases_.size() && phases_[next_phase_].begin_s <= to_s) {
      const Phase& next = phases_[next_phase_];
      if (!Integrate(next.begin_s)) return false;
      if (next.stage != motion_.phase.stage) Separate(scenario_, motion_.phase, next, time_s_, y_.data());
      motion_.phase = next;
      ++next_phase_;
    }
    return Integrate(to_s);
  }

  bool Integrate(double to_s) {
    if (!(to_s > time_s_)) return true;
    // Rounding of the quotient must not cost a step.
    const double steps = std::ceil((to_s - time_s_) / scenario_.integration_step_s - 1e-6);
    if (!integrator_.Advance(time_s_, to_s, steps < 1.0 ? 1 : static_cast<int>(steps), y_.data())) {
      flight_.outcome = Outcome::kNumericalFailure;
      flight_.reason = "the integrator failed or the state is not finite";
      return false;
    }
    time_s_ = to_s;
    RigidBodyState state = ReadState(y_.data());
    state.q_IB = Normalized(state.q_IB);
    WriteState(state, y_.data());
    return true;
  }

  void AddSample() {
    flight_.samples.push_back(Evaluate(motion_, time_s_, y_.data()));
    digester_.Add(&time_s_, 1);
    digester_.Add(y_.data(), y_.size());
  }

  const Scenario& scenario_;
  std::vector<Phase> phases_;
  Motion motion_;
  Integrator integrator_;
  std::size_t next_phase_ = 1;
  double time_s_ = 0.0;
  std::array<double, kRigidBodySize> y_{};
  ScenarioFlight flight_;
  Digester digester_;
};

}  // namespace

RigidBodyState InitialState(const Scenario& scenario) {
  const Earth& earth = scenario.environment.earth;
  const Vector3 w_IE_I(0.0, 0.0, earth.rotation_rate_rad_s);
  const Matrix3 R_IN = NedAxes(scenario.place.latitude_rad, scenario.place.longitude_rad);
  RigidBodyState state;
  state.p_EoC_I = FromGeodetic(earth, scenario.place);
  state.v_IC_I = R_IN * scenario.v_EC_N + w_IE_I.cross(state.p_EoC_I);
  state.q_IB = QuaternionOf(R_IN) * FromYawPitchRoll(scenario.attitude);
  state.w_IB_B = scenario.rates_rad_s;
  if (!scenario.rates_are_inertial) state.w_IB_B += Rotate(Inverse(state.q_IB), w_IE_I);
  return state;
}

ScenarioFlight FlyScenario(const Scenario& scenario, Scheme scheme) { return Flight(scenario, scheme).Run(); }

std::vector<double> HistoryRows(const Scenario& scenario, const std::vector<ScenarioSample>& samples) {
  std::vector<double> rows;
  for (const ScenarioSample& s : samples)
    AppendKinematics(scenario.environment.earth, s.time_s, s.state, s.air, s.v_AB_B, s.loads.mass_kg, rows);
  return rows;
}

}  // namespace dispersa
