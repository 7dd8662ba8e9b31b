// The order of the engine's step, on powered flight without kinks, without controller and with a constant
// command.
#include "core/flight/simpson_step.h"
#include "core/dynamics/aero_grid.h"
#include "core/dynamics/integrator.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::simpson_step_test {
namespace {

constexpr double kFloors[] = {1e-7, 3e-8, 1e-10, 1e-10};  // m, m/s, rad, rad/s
constexpr double kFrom_s = 20.0, kTo_s = 21.0;

// The first stack of the shipped vehicle with coefficients that do not bend, at 20 s, turning slowly with its
// nozzles deflected.
class Stretch {
 public:
  Stretch() : plant_(BuildNominalPlant(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"))) {
    BodyAerodynamics& body = plant_.stacks[0].aerodynamics;
    for (Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) {
      c->table = {{0.0, 20.0}, {0.0, kPi}, {}};
      c->table.z = c == &body.cn ? std::vector<double>{0.0, 9.0, 0.0, 9.0}
                                 : std::vector<double>(4, c == &body.ca ? 0.4 : 6.0);
    }
    plant_.stacks[0].aero_grid = std::make_shared<const AeroGrid>(BuildAeroGrid(body));
    phase_.burning = true;
    RigidBodyState s;
    s.p_EoC_I = FromGeodetic(plant_.environment.earth, {0.4, 1.1, 2500.0});
    s.q_IB = FromRotationVector(Vector3(0.3, -1.2, 0.4));
    const Vector3 earth_rate_I(0.0, 0.0, plant_.environment.earth.rotation_rate_rad_s);
    s.v_IC_I = earth_rate_I.cross(s.p_EoC_I) + Rotate(s.q_IB, Vector3(300.0, 4.0, -9.0));
    s.w_IB_B = Vector3(0.2, 0.02, -0.03);
    WriteState(s, y_);
    for (int i = 0; i < kNozzles; ++i) {
      y_[kNozzleAngle + i] = 0.001 * (i + 1);
      phase_.command_rad[static_cast<std::size_t>(i)] = 0.004 - 0.002 * i;
    }
  }

  RigidBodyState Exact() {
    double y[kLauncherSize], tolerances[kLauncherSize];
    std::copy(y_, y_ + kLauncherSize, y);
    for (double& t : tolerances) t = 1e-15;
    const LauncherModel equations(plant_);
    equations_ = &equations;
    Integrator cvode(Scheme::kCvode, kRigidLauncherSize, &Rhs, this, tolerances);
    EXPECT_TRUE(cvode.Advance(kFrom_s, kTo_s, 1, y));
    return ReadState(y);
  }
  std::unique_ptr<lanes::StepState<double>> Before(double tick_s) const {
    static const FlightWeather calm;
    auto step = std::make_unique<lanes::StepState<double>>();
    step->Configure(plant_, tick_s);
    step->StartFlight(0, calm, y_);
    step->SetStack(0, plant_, 0);
    step->Ignite(0, 0.0, false);
    step->CommandLane(0, 0, phase_.command_rad.data());
    return step;
  }
  RigidBodyState InSteps(int steps) {
    const auto step = Before((kTo_s - kFrom_s) / steps);
    const auto time = [&](int k) { return kFrom_s + (kTo_s - kFrom_s) * k / steps; };
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(step->Step(true, true, time(k), time(k + 1)));
    double y[kLauncherSize];
    step->ReadLane(0, y);
    return ReadState(y);
  }
  LauncherPlant& plant() { return plant_; }
  const double* y() const { return y_; }

 private:
  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const Stretch*>(context);
    self->equations_->Derivative(self->phase_, t, y, dydt);
  }

  LauncherPlant plant_;
  const LauncherModel* equations_ = nullptr;
  LauncherPhase phase_;
  double y_[kLauncherSize] = {};
};

TEST(SimpsonStep, HasItsOrder) {
  Stretch stretch;
  const RigidBodyState exact = stretch.Exact();
  double last[4] = {};
  for (const int steps : {25, 50, 100}) {
    const RigidBodyState s = stretch.InSteps(steps);
    const double error[4] = {(s.p_EoC_I - exact.p_EoC_I).norm(), (s.v_IC_I - exact.v_IC_I).norm(),
                             RotationVector(Inverse(exact.q_IB) * s.q_IB).norm(),
                             (s.w_IB_B - exact.w_IB_B).norm()};
    for (int i = 0; i < 4; ++i) {
      // Order 3 at least. Here the guesses of the velocities hardly matter, and a sixteenth is left, of which
      // terms of higher order may take a third. Below the floors are the rounding of 6e6 m and CVODE's
      // tolerance.
      if (last[i] > 0.0) {
        EXPECT_LT(error[i], std::max(last[i] / 10.0, kFloors[i])) << i << ", " << steps << " steps";
      }
      last[i] = error[i];
    }
  }
}

// The next step goes on from what was written, as if nothing had been evaluated before.
TEST(SimpsonStep, SeesWhatWasWritten) {
  using Step = lanes::StepState<double>;
  constexpr double kTick_s = 0.01;
  Stretch stretch;
  Gimbal& gimbal = stretch.plant().stacks[0].gimbal;
  gimbal.nozzle_mass_kg = 200.0;
  gimbal.nozzle_cg_m = 0.3;
  gimbal.nozzle_inertia_kg_m2 = 40.0;
  StackMass lighter = stretch.plant().stacks[0].mass;
  lighter.fixed_mass_kg -= 50.0;
  double moved[kLauncherSize] = {};
  std::copy_n(stretch.y(), kRigidLauncherSize, moved);
  moved[3] += 1.0;
  const double command_rad[kDrives] = {0.01, -0.01, 0.01, 0.01};
  const std::pair<const char*, std::function<void(Step&)>> writers[] = {
      {"WriteLane", [&](Step& step) { step.WriteLane(0, moved); }},
      {"SetStack", [&](Step& step) { step.SetStack(0, stretch.plant(), 1); }},
      {"SetMass", [&](Step& step) { step.SetMass(0, lighter, nullptr); }},
      {"Ignite", [](Step& step) { step.Ignite(0, 5.0, false); }},
      {"BurnOut", [](Step& step) { step.BurnOut(0); }},
      {"StickNozzle", [&](Step& step) { step.StickNozzle(0, gimbal, 1, 0.03); }},
      {"Command", [&](Step& step) { step.Command(true, 0, command_rad); }},
      {"CommandLane", [&](Step& step) { step.CommandLane(0, 0, command_rad); }},
      {"SetControlTorque",
       [](Step& step) {
         step.SetControlTorque(true, {0.0, 300.0, 0.0});
       }},
      {"Expel", [](Step& step) { step.Expel(true, 5.0, 2.0); }},
  };
  const auto after = [&](const std::function<void(Step&)>& write, bool evaluated) {
    const auto step = stretch.Before(kTick_s);
    if (evaluated) step->EvaluateStart(kFrom_s);
    write(*step);
    EXPECT_TRUE(step->Step(true, true, kFrom_s, kFrom_s + kTick_s));
    std::vector<double> y(kLauncherSize);
    step->ReadLane(0, y.data());
    return y;
  };
  const std::vector<double> unwritten = after([](Step&) {}, true);
  for (const auto& [name, write] : writers) {
    const std::vector<double> y = after(write, true);
    EXPECT_EQ(y, after(write, false)) << name;
    EXPECT_NE(y, unwritten) << name << " writes something";
  }
}

TEST(SimpsonStep, AStateThatIsNotFiniteIsNotTaken) {
  auto step = std::make_unique<lanes::StepState<lanes::Pack<4>>>();
  const LauncherPlant plant = BuildNominalPlant(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"));
  step->Configure(plant, 0.01);
  const FlightWeather calm;
  double y[kLauncherSize] = {6.4e6, 0, 0, 0, 100, 0, 1};
  for (int lane = 0; lane < 4; ++lane) {
    y[10] = lane == 2 ? std::numeric_limits<double>::quiet_NaN() : 0.1;
    step->StartFlight(lane, calm, y);
    step->SetStack(lane, plant, 0);
  }
  auto moving = lanes::NoLane<lanes::Pack<4>>();
  for (int lane = 0; lane < 4; ++lane) lanes::SetLane(moving, lane, true);
  const auto accepted = step->Step(moving, true, 0.0, 0.01);
  EXPECT_EQ(lanes::Bits(accepted), 0b1011u);
  step->ReadLane(2, y);
  EXPECT_EQ(y[0], 6.4e6) << "left where it was";
  step->ReadLane(1, y);
  EXPECT_NE(y[1], 0.0) << "moved";
}

}  // namespace
}  // namespace dispersa::simpson_step_test
