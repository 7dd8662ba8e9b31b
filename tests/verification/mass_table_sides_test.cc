// Mass tables of stages whose centre of gravity is off the axis: mass, centre and tensor against bodies by
// hand, the equation of rotation, the nozzles' trim, separation, and drawn dry masses.
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/apart_boosters.h"
#include "tests/flown_ticks.h"
#include "tests/tabulated_masses.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::mass_table_sides_test {
namespace {

constexpr double kDry_kg = 6000.0, kPropellant_kg = 4000.0, kFlow_kg_s = 100.0, kThrust_n = 200e3,
                 kPivot_m = 19.5;
constexpr int kRows = 9;

// The dry stage, as far to the right as down, with a tunnel on either side: it has more inertia about z.
std::vector<Part> Dry(double factor = 1.0) {
  constexpr double kTunnel_kg = 500.0, kOff_m = 180.0 / (kDry_kg - 2.0 * kTunnel_kg);
  const auto tunnel = [factor](double y_m) {
    return Part{factor * kTunnel_kg, factor * 10.0, factor * 2e3, Vector3(15.5, y_m, 0.0)};
  };
  return {
      {factor * (kDry_kg - 2.0 * kTunnel_kg), factor * 1500.0, factor * 20e3, Vector3(15.5, kOff_m, kOff_m)},
      tunnel(1.2),
      tunnel(-1.2)};
}
// The grain burns from its bore outwards.
Part GrainOf(double kg) {
  const double outer2 = 0.36, inner2 = outer2 - kg / kPropellant_kg * (0.36 - 0.04);
  return {kg, 0.5 * kg * (outer2 + inner2), kg * (0.25 * (outer2 + inner2) + 36.0 / 12.0),
          Vector3(15.0, 0.0, 0.0)};
}

// The sample vehicle, which flies in almost no air, with a table of its first stage's parts.
FlightDefinition WithTable() {
  FlightDefinition definition = HighDefinition();
  Stage& stage = definition.vehicle.stages[0];
  MassTable table;
  for (int i = 0; i < kRows; ++i) {
    const double kg = kPropellant_kg * i / (kRows - 1);
    std::vector<Part> parts = Dry();
    parts.push_back(GrainOf(kg));
    const Bodies all = SumOf(parts);
    table.propellant_kg.push_back(kg);
    table.cg_station_m.push_back(all.cg.x());
    table.cg_y_m.push_back(all.cg.y());
    table.cg_z_m.push_back(all.cg.z());
    table.axial_inertia_kg_m2.push_back(all.inertia(0, 0));
    table.transverse_inertia_kg_m2.push_back(all.inertia(1, 1));
    table.yaw_inertia_kg_m2.push_back(all.inertia(2, 2));
    table.product_xy_kg_m2.push_back(-all.inertia(0, 1));
    table.product_xz_kg_m2.push_back(-all.inertia(0, 2));
    table.product_yz_kg_m2.push_back(-all.inertia(1, 2));
    EXPECT_GT(all.inertia(2, 2), 1.03 * all.inertia(1, 1));
  }
  EXPECT_GT(std::fabs(table.product_xy_kg_m2.back()), 10.0) << "the grain is not where the dry stage is";
  stage.mass_table = table;
  stage.flown_mass.rows = std::make_shared<const MassRows>(BuildMassRows(table, kDry_kg));
  return definition;
}

// The stack above, which lies on the axis.
Part Above(const FlightDefinition& definition) {
  const MassProperties at = BuildStackMasses(definition.vehicle)[1].At(1000.0);
  return {at.mass_kg, at.axial_inertia_kg_m2, at.transverse_inertia_kg_m2,
          Vector3(at.cg_station_m, 0.0, 0.0)};
}
Bodies ByHand(const FlightDefinition& definition, double propellant_kg, double dry_factor = 1.0) {
  std::vector<Part> parts = Dry(dry_factor);
  parts.insert(parts.end(), {GrainOf(propellant_kg), Above(definition)});
  return SumOf(parts);
}

void ExpectMasses(const LauncherPlant& plant, const LauncherPhase& phase, double since_s, const Bodies& all) {
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  const LauncherInstant now = LauncherModel(plant).Evaluate(phase, since_s, y.data());
  EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << since_s;
  EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x()) << since_s;
  EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm()) << since_s;
}

TEST(MassTableSides, AreThoseOfTheBodiesByHand) {
  const FlightDefinition definition = WithTable();
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  LauncherPhase phase;
  phase.burning = true;
  for (const double since_s : {0.0, 5.0, 20.0, 35.0, 40.0}) {  // at the rows
    const double left_kg = kPropellant_kg - kFlow_kg_s * since_s;
    const Bodies all = ByHand(definition, left_kg);
    ExpectMasses(plant, phase, since_s, all);
    const Vector3 lateral_kg_m = LateralMoment(plant.stacks[0], left_kg);
    EXPECT_NEAR(lateral_kg_m.y(), all.cg.y() * all.mass_kg, 1e-9 * kDry_kg);
    EXPECT_NEAR(lateral_kg_m.z(), all.cg.z() * all.mass_kg, 1e-9 * kDry_kg);
  }
}

// A drawn dry mass scales what is dry, off the axis as on it. The draw of a centre of gravity adds to it.
TEST(MassTableSides, ScaleWithTheDryMass) {
  const FlightDefinition definition = WithTable();
  FlightInputs in;
  in.stages[0].dry_mass_factor = 1.1;
  in.stages[0].cg_offset_m.y = -0.01;
  const LauncherPlant plant = FlightModel(definition).PlantFor(in);
  LauncherPhase phase;
  phase.burning = true;
  const Bodies all = ByHand(definition, 2000.0, 1.1);
  ExpectMasses(plant, phase, 20.0, all);
  EXPECT_NEAR(LateralMoment(plant.stacks[0], 2000.0).y(),
              all.cg.y() * all.mass_kg - 0.01 * (1.1 * kDry_kg + 3000.0), 1e-9 * kDry_kg);
}

// Without forces but gravitation, I dw/dt = -w x I w with the tensor by hand.
TEST(MassTableSides, TurnAsTheirTensorSays) {
  const FlightDefinition definition = WithTable();
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  const Matrix3 inertia = ByHand(definition, kPropellant_kg).inertia;
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  s.w_IB_B = {0.3, -0.2, 0.15};
  std::array<double, kLauncherSize> y{}, dydt{};
  WriteState(s, y.data());
  LauncherModel(plant).Derivative({}, 0.0, y.data(), dydt.data());
  const Vector3 expected = -(inertia.inverse() * s.w_IB_B.cross(inertia * s.w_IB_B));
  EXPECT_NEAR((ReadState(dydt.data()).w_IB_B - expected).norm(), 0.0, 1e-9 * expected.norm());
  const Vector3 diagonal = inertia.diagonal();
  const Vector3 without = -s.w_IB_B.cross(diagonal.asDiagonal() * s.w_IB_B).cwiseQuotient(diagonal);
  EXPECT_GT((without - expected).norm(), 1e-3 * expected.norm()) << "the products count";
}

// The autopilot does not know the offset. The nozzles trim the moment of the thrust about the centre, as of
// the same offset as a dispersion of the centre of gravity without the burning propellant: 180 kg m of 9 t.
TEST(MassTableSides, AreTrimmedAsADispersedOffsetIs) {
  const FlightDefinition definition = WithTable();
  FlightDefinition on_axis = definition;
  MassTable table = on_axis.vehicle.stages[0].mass_table;
  for (auto* column : table.Sides())
    if (column != &table.yaw_inertia_kg_m2) column->clear();
  on_axis.vehicle.stages[0].flown_mass.rows = std::make_shared<const MassRows>(BuildMassRows(table, kDry_kg));
  FlightInputs dispersed;
  dispersed.stages[0].cg_offset_m.y = dispersed.stages[0].cg_offset_m.z = 180.0 / 9000.0;
  FlightResult result, same;
  const auto ticks = TicksOf(definition, {}, &result), others = TicksOf(on_axis, dispersed, &same);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  ASSERT_EQ(ticks.size(), others.size());
  int seen = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const TickSample& s = ticks[i];
    if (s.stack != 0 || s.time_s < 15.0 || s.time_s > 35.0) continue;
    const Bodies all = ByHand(definition, kPropellant_kg - kFlow_kg_s * s.since_ignition_s);
    const double lever_m = kPivot_m - all.cg.x(), quarter_n = 0.25 * kThrust_n;
    const auto sine = [&](std::size_t k) { return std::sin(s.nozzle_rad[k]); };
    // The force turns towards -y by the third and fourth nozzle, and towards z by the first two.
    const double yaw = all.cg.y() * kThrust_n + lever_m * quarter_n * (sine(2) + sine(3));
    const double pitch = -all.cg.z() * kThrust_n + lever_m * quarter_n * (sine(0) + sine(1));
    // The centre moves as the propellant burns, and the vehicle turns after it.
    EXPECT_NEAR(yaw, 0.0, 0.04 * all.cg.y() * kThrust_n) << s.time_s;
    EXPECT_NEAR(pitch, 0.0, 0.04 * all.cg.z() * kThrust_n) << s.time_s;
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(s.nozzle_rad[k], others[i].nozzle_rad[k], 0.02 * std::fabs(s.nozzle_rad[k])) << s.time_s;
    ++seen;
  }
  EXPECT_GT(seen, 1000);
}

// The burnt stage and the stack above keep their momentum and their common centre.
TEST(MassTableSides, SeparationKeepsTheMomentum) {
  const FlightDefinition definition = WithTable();
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  const Bodies all = ByHand(definition, 0.0);
  const Part above = Above(definition);
  RigidBodyState s;
  s.p_EoC_I = {7e6, 1e5, -2e5};
  s.v_IC_I = {100.0, 7000.0, 50.0};
  s.w_IB_B = {0.01, -0.02, 0.03};
  s.q_IB = FromRotationVector(Vector3(0.3, -0.7, 0.2));
  const RigidBodyState left = AfterSeparation(plant, 0, 0u, s);
  const Bodies dry = SumOf(Dry());
  const RigidBodyState spent =
      AtPoint(s, Vector3(all.cg.x() - dry.cg.x(), dry.cg.y() - all.cg.y(), dry.cg.z() - all.cg.z()));
  const Vector3 momentum = above.kg * left.v_IC_I + dry.mass_kg * spent.v_IC_I;
  EXPECT_NEAR((momentum - all.mass_kg * s.v_IC_I).norm(), 0.0, 1e-10 * momentum.norm());
  const Vector3 moved = above.kg * (left.p_EoC_I - s.p_EoC_I) + dry.mass_kg * (spent.p_EoC_I - s.p_EoC_I);
  EXPECT_NEAR(moved.norm(), 0.0, 1e-8 * all.mass_kg);
  EXPECT_GT(all.cg.tail<2>().norm(), 0.02);
}

}  // namespace
}  // namespace dispersa::mass_table_sides_test
