// Mass properties against sums by hand and against their own numerical derivatives.
#include "core/vehicle/mass.h"

#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_mass_test {
namespace {

// Sums of a handful of products: rounding only.
constexpr double kRounding = 1e-12;

TEST(DryMass, IsWhatLiftOffMassLeavesAfterStagesAboveAndPropellant) {
  const Vehicle vehicle = SampleVehicle();
  EXPECT_DOUBLE_EQ(DryMass(vehicle, 0), 13000.0 - 3000.0 - 4000.0);
  EXPECT_DOUBLE_EQ(DryMass(vehicle, 1), 3000.0 - 1000.0);
}

TEST(PropellantDensity, IsMassOverTheGrainsVolume) {
  // pi/4 (1.2² - 0.4²) 6 m = 6.0318579 m3
  EXPECT_NEAR(PropellantDensity(SampleVehicle().stages[0]), 4000.0 / (0.25 * kPi * 1.28 * 6.0), 1e-10);
}

TEST(StackMass, FullAndEmptyMassesAreTable1sReading) {
  const Vehicle vehicle = SampleVehicle();
  const auto stacks = BuildStackMasses(vehicle);
  ASSERT_EQ(stacks.size(), 2u);
  EXPECT_NEAR(stacks[0].At(4000.0).mass_kg, 13000.0, 13000.0 * kRounding);
  EXPECT_NEAR(stacks[0].At(0.0).mass_kg, 9000.0, 9000.0 * kRounding);
  EXPECT_NEAR(stacks[1].At(1000.0).mass_kg, 3000.0, 3000.0 * kRounding);
}

TEST(StackMass, CentreOfGravityAndInertiaOfAnEmptySingleTube) {
  // The upper stack without propellant is one tube of 2000 kg from 1 m to 10.5 m, radii 0.5 and 0.45 m.
  const Vehicle vehicle = SampleVehicle();
  const MassProperties m = BuildStackMasses(vehicle)[1].At(0.0);
  EXPECT_NEAR(m.cg_station_m, 5.75, 5.75 * kRounding);
  EXPECT_NEAR(m.axial_inertia_kg_m2, 0.5 * 2000.0 * (0.25 + 0.2025), 1000.0 * kRounding);
  // The transverse inertia is a difference of second moments about the nose (81 000): hence the factor.
  EXPECT_NEAR(m.transverse_inertia_kg_m2, 2000.0 * ((0.25 + 0.2025) / 4.0 + 9.5 * 9.5 / 12.0),
              1e5 * kRounding);
}

TEST(StackMass, FullStackByHuygensAndSteinerElementByElement) {
  struct Piece {
    double mass, top, bottom, outer, inner;
  };
  // 6000 kg dry: 4500 + 1500; grain 4000; upper stage 2000 + grain 1000.
  const std::vector<Piece> pieces = {{4500.0, 11.0, 19.0, 0.6, 0.55},
                                     {1500.0, 19.0, 20.0, 0.4, 0.0},
                                     {4000.0, 12.0, 18.0, 0.6, 0.2},
                                     {2000.0, 1.0, 10.5, 0.5, 0.45},
                                     {1000.0, 6.0, 9.0, 0.45, 0.15}};
  double mass = 0.0, moment = 0.0;
  for (const Piece& p : pieces) {
    mass += p.mass;
    moment += p.mass * 0.5 * (p.top + p.bottom);
  }
  const double cg = moment / mass;
  double axial = 0.0, transverse = 0.0;
  for (const Piece& p : pieces) {
    const double radii = p.outer * p.outer + p.inner * p.inner;
    const double length = p.bottom - p.top;
    const double arm = 0.5 * (p.top + p.bottom) - cg;
    axial += 0.5 * p.mass * radii;
    transverse += p.mass * (0.25 * radii + length * length / 12.0 + arm * arm);
  }
  const Vehicle vehicle = SampleVehicle();
  const MassProperties m = BuildStackMasses(vehicle)[0].At(4000.0);
  EXPECT_NEAR(m.cg_station_m, cg, cg * kRounding);
  EXPECT_NEAR(m.axial_inertia_kg_m2, axial, axial * kRounding);
  EXPECT_NEAR(m.transverse_inertia_kg_m2, transverse, 10.0 * transverse * kRounding);
}

TEST(StackMass, BoreStartsAtItsDiameterAndReachesTheCaseAtBurnout) {
  const Vehicle vehicle = SampleVehicle();
  const StackMass stack = BuildStackMasses(vehicle)[0];
  // axial_inertia_per_kg is the bore's radius squared.
  EXPECT_NEAR(stack.At(4000.0).axial_inertia_per_kg, 0.2 * 0.2, 1e-14);
  EXPECT_NEAR(stack.At(0.0).axial_inertia_per_kg, 0.6 * 0.6, 1e-14);
}

TEST(StackMass, DerivativesByPropellantAgreeWithDifferences) {
  const Vehicle vehicle = SampleVehicle();
  const StackMass stack = BuildStackMasses(vehicle)[0];
  const double step_kg = 1.0;
  for (const double propellant : {200.0, 1700.0, 3900.0}) {
    const MassProperties here = stack.At(propellant);
    const MassProperties more = stack.At(propellant + step_kg), less = stack.At(propellant - step_kg);
    // Central differences: truncation of (step / mass)² and rounding of 3e5 kg m² * 1e-16 / step.
    EXPECT_NEAR((more.axial_inertia_kg_m2 - less.axial_inertia_kg_m2) / (2.0 * step_kg),
                here.axial_inertia_per_kg, 1e-8);
    EXPECT_NEAR((more.transverse_inertia_kg_m2 - less.transverse_inertia_kg_m2) / (2.0 * step_kg),
                here.transverse_inertia_per_kg, 1e-6);
  }
}

}  // namespace
}  // namespace dispersa::vehicle_mass_test
