// Points of application of forces: for any vehicle, a moment is a lever times a force. Each case is compared
// with the same case with one thing moved.
#include "core/dynamics/launcher.h"
#include "core/flight/flight_model.h"
#include "core/math/constants.h"
#include "core/math/rotation.h"
#include "core/vehicle/nozzle_layout.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::dynamics_forces_test {
namespace {

// The sample vehicle with nozzles that have mass, on their way, so that everything pushes.
Vehicle Pushing(Vehicle vehicle) {
  for (Stage& stage : vehicle.stages) {
    stage.gimbal.nozzle_mass_kg = 60.0;
    stage.gimbal.nozzle_cg_m = 0.3;
    stage.gimbal.nozzle_inertia_kg_m2 = 8.0;
  }
  vehicle.profile = {{ProfileShape::kTangentOgive, 2.0, 1.0}, {ProfileShape::kCylinder, 18.0, 1.0}};
  return vehicle;
}
Vehicle Boosted() {
  Vehicle vehicle = Pushing(SampleVehicle());
  vehicle.boosters = {3, 100.0, 500.0, 0.9, 0.5, 14.0, 19.0, 19.2, {}, {15.0, 18.0, 0.48, 0.2}, 0.5};
  vehicle.boosters.motor.thrust_n = 60e3;
  vehicle.boosters.motor.burning_time_s = 20.0;
  vehicle.stages[0].liftoff_mass_kg += 1800.0;
  return vehicle;
}
LauncherPlant Bending() {
  Vehicle vehicle = Pushing(FlexibleSample());
  vehicle.structure_beam->elements = 12;
  vehicle.structure_beam->propellant_levels = 3;
  vehicle.structure_beam->modes = vehicle.structure_beam->flown_modes = 2;
  LauncherPlant plant = BuildNominalPlant(vehicle);
  AddBending(vehicle, 0.001, plant);
  return plant;
}

constexpr double kTime_s = 10.0;

struct Case {
  const char* name;
  LauncherPlant plant;
  LauncherPhase phase;
  std::array<double, kLauncherSize> y{};
};
// In air, at an incidence from below and from the right. It does not turn, so that nothing is damped.
Case CaseOf(const char* name, const LauncherPlant& plant, bool burning, bool boosting = false) {
  Case c{name, plant, {}, {}};
  c.phase.burning = burning;
  c.phase.boosters_burning = boosting ? kAllBoosters : 0u;
  const Earth& earth = plant.environment.earth;
  RigidBodyState s;
  s.p_EoC_I = FromGeodetic(earth, {0.3, 0.7, 9000.0});
  s.q_IB = FromRotationVector(Vector3(0.4, -0.9, 0.2));
  s.v_IC_I = Vector3(0.0, 0.0, earth.rotation_rate_rad_s).cross(s.p_EoC_I) +
             Rotate(s.q_IB, Vector3(400.0, 9.0, 14.0));
  WriteState(s, c.y.data());
  for (std::size_t i = 0; i < kNozzles; ++i) {
    c.y[kNozzleAngle + i] = 0.01 * (1.0 + static_cast<double>(i));
    c.phase.command_rad[i] = 0.05 - 0.03 * static_cast<double>(i);
  }
  if (plant.bending_modes() > 0) {
    c.y[kModalState] = 0.02;
    c.y[kModalState + kModes + 1] = -0.01;
    c.y[kModalRate + 1] = 0.3;
  }
  return c;
}
std::vector<Case> Cases() {
  const LauncherPlant plain = BuildNominalPlant(Pushing(SampleVehicle()));
  return {CaseOf("coasting", plain, false), CaseOf("burning", plain, true),
          CaseOf("boosted", BuildNominalPlant(Boosted()), true, true), CaseOf("bending", Bending(), true)};
}
BodyLoads LoadsOf(const Case& c) {
  return LauncherModel(c.plant).Evaluate(c.phase, kTime_s, c.y.data()).loads;
}

// Moving the centre of gravity aside moves no force: the moment about it changes by that lever times their
// sum.
TEST(Forces, HaveTheirMomentsAboutACentreThatIsOffTheAxis) {
  for (const Case& straight : Cases()) {
    const BodyLoads before = LoadsOf(straight);
    for (const Vector3& aside :
         {Vector3(0.0, 0.03, 0.0), Vector3(0.0, 0.0, -0.02), Vector3(0.0, 0.01, 0.04)}) {
      Case moved = straight;
      moved.plant.stacks[0].lateral_moment_y_kg_m = aside.y() * before.mass_kg;
      moved.plant.stacks[0].lateral_moment_z_kg_m = aside.z() * before.mass_kg;
      const BodyLoads after = LoadsOf(moved);
      EXPECT_NEAR((after.force_n - before.force_n).norm(), 0.0, 1e-9 * before.force_n.norm())
          << straight.name;
      const Vector3 expected = before.moment_n_m - aside.cross(before.force_n);
      EXPECT_NEAR((after.moment_n_m - expected).norm(), 0.0, 1e-9 * before.force_n.norm()) << straight.name;
    }
  }
}

// The cross is four nozzles of a list: with whatever sets each apart, thrust and reaction are the same.
TEST(Forces, OfACrossAreThoseOfTheListThatItIs) {
  Case cross = CaseOf("cross", BuildNominalPlant(Pushing(SampleVehicle())), true);
  for (std::size_t i = 0; i < kNozzles; ++i) {
    NozzleDeparture& departs = cross.plant.stacks[0].nozzles[i];
    const double k = static_cast<double>(i);
    departs.tilt = RotationMatrix(FromRotationVector(Vector3(0.0, 0.01 - 0.004 * k, 0.003 * k)));
    departs.thrust_factor = 0.97 + 0.02 * k;
    departs.offset_y_m = 0.01 * k - 0.02;
    departs.offset_z_m = 0.015 - 0.01 * k;
  }
  Case list = cross;
  for (LauncherStack& stack : list.plant.stacks) {
    const double r = stack.gimbal.radius_m;
    stack.gimbal.nozzles = {{"right", r, 0.0, 0.25, {90.0 * kRadPerDeg}, 0.0},
                            {"left", -r, 0.0, 0.25, {90.0 * kRadPerDeg}, 0.0},
                            {"bottom", 0.0, r, 0.25, {180.0 * kRadPerDeg}, 0.0},
                            {"top", 0.0, -r, 0.25, {180.0 * kRadPerDeg}, 0.0}};
    stack.layout = BuildNozzleLayout(stack.gimbal);
  }
  const BodyLoads of_cross = LoadsOf(cross), of_list = LoadsOf(list);
  // Rounding of the sums.
  EXPECT_NEAR((of_list.force_n - of_cross.force_n).norm(), 0.0, 1e-12 * of_cross.force_n.norm());
  EXPECT_NEAR((of_list.moment_n_m - of_cross.moment_n_m).norm(), 0.0, 1e-12 * of_cross.force_n.norm());
}

// A thrust that acts beside the axis turns the pivots besides pushing them: virtual work on each mode.
TEST(Forces, BesideTheAxisDriveTheModesByTheirCouple) {
  Case straight = CaseOf("bending", Bending(), true);
  ModeTable stiff = *straight.plant.stacks[0].bending;  // the pivot turns with the modes alone
  for (std::size_t row = 0; row < stiff.rows.size(); row += ModeTable::kRowSize)
    for (std::size_t i = 0; i < 3; ++i) stiff.rows[row + ModeTable::kResidual + i] = 0.0;
  straight.plant.stacks[0].bending = std::make_shared<const ModeTable>(std::move(stiff));
  straight.y.fill(0.0);
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  WriteState(s, straight.y.data());
  straight.phase.command_rad.fill(0.0);
  Case beside = straight;
  const double y_m = 0.02, z_m = -0.03;
  beside.plant.stacks[0].thrust_offset_y_m = y_m;
  beside.plant.stacks[0].thrust_offset_z_m = z_m;
  std::array<double, kLauncherSize> from{}, to{};
  LauncherModel(straight.plant).Derivative(straight.phase, kTime_s, straight.y.data(), from.data());
  LauncherModel(beside.plant).Derivative(beside.phase, kTime_s, beside.y.data(), to.data());
  const ModeTable& table = *straight.plant.stacks[0].bending;
  const double propellant_kg = straight.plant.stacks[0].burn.Propellant(kTime_s);
  for (int mode = 0; mode < table.modes; ++mode) {
    const auto at = [&](int column) { return table.At(0, mode, column, propellant_kg); };
    // The point of action moves along x by z times the turn about y, and by -y times the turn about z, which
    // is -slope.
    const double per_metre = 200e3 * at(ModeTable::kPivotSlope) * at(ModeTable::kInverseMass);
    const std::size_t y = static_cast<std::size_t>(kModalRate + mode), z = y + kModes;
    EXPECT_NEAR(to[y] - from[y], y_m * per_metre, 1e-9) << mode;
    EXPECT_NEAR(to[z] - from[z], z_m * per_metre, 1e-9) << mode;
  }
}

// Each flow is pushed aside on its own way through the turning body: the core's from its grain's middle at 15
// m to 19.5 m, the boosters' from 16.5 m to 19.2 m.
TEST(Forces, OfCoriolisAreOfEachFlowOnItsOwnWay) {
  Case still = CaseOf("boosted", BuildNominalPlant(Boosted()), true, true);
  RigidBodyState s = ReadState(still.y.data());
  s.w_IB_B = {0.0, 0.2, -0.1};
  WriteState(s, still.y.data());
  Case flowing = still;
  still.plant.flow_coriolis = false;
  const Vector3 pushed = LoadsOf(flowing).force_n - LoadsOf(still).force_n;
  const double way_kg_m_s = 100.0 * 4.5 + 75.0 * 2.7;
  EXPECT_NEAR((pushed - 2.0 * way_kg_m_s * s.w_IB_B.cross(Vector3::UnitX())).norm(), 0.0, 1e-8);
}

}  // namespace
}  // namespace dispersa::dynamics_forces_test
