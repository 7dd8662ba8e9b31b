// Fins against the limits of their theories, and against numbers computed by hand.
#include "core/vehicle/fins.h"

#include "core/math/constants.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "core/vehicle/vehicle.h"
#include "tests/test.h"

namespace dispersa::vehicle_fins_test {
namespace {

FinSet Rectangle(double chord_m, double span_m) {
  FinSet fins;
  fins.leading_edge_station_m = 5.0;
  fins.root_chord_m = fins.tip_chord_m = chord_m;
  fins.span_m = span_m;
  return fins;
}

TEST(Fins, OfGreatSpanLiftLikeAPlateInTwoDimensions) {
  const FinSet fins = Rectangle(0.1, 100.0);  // aspect ratio 2000
  // 2 pi over the incidence in incompressible flow, 2 pi / sqrt(1 - M²) after Prandtl and Glauert, 4 /
  // sqrt(M² - 1) after Ackeret.
  EXPECT_NEAR(FinLiftArea(fins, 0.0) / FinArea(fins), kTwoPi, 0.01);
  EXPECT_NEAR(FinLiftArea(fins, 0.6) / FinArea(fins), kTwoPi / 0.8, 0.01);
  EXPECT_NEAR(FinLiftArea(fins, std::sqrt(2.0)) / FinArea(fins), 4.0, 0.01);
  EXPECT_NEAR(FinLiftArea(fins, 3.0) / FinArea(fins), 4.0 / std::sqrt(8.0), 0.01);
}

TEST(Fins, OfSmallSpanLiftLikeASlenderWing) {
  const FinSet fins = Rectangle(2.0, 0.05);  // aspect ratio 0.05
  // R. T. Jones: pi R / 2.
  EXPECT_NEAR(FinLiftArea(fins, 0.3) / FinArea(fins), 0.5 * kPi * 0.05, 1e-4);
}

TEST(Fins, ForceIsContinuousOverMach) {
  const FinSet fins = Rectangle(0.4, 0.3);
  double before = FinLiftArea(fins, 0.0);
  for (double mach = 0.001; mach < 9.0; mach += 0.001) {
    const double now = FinLiftArea(fins, mach);
    EXPECT_LT(std::fabs(now - before), 0.003 * before) << mach;
    before = now;
  }
}

TEST(Fins, CarryOverIsThatOfSlenderBodies) {
  const FinSet fins = Rectangle(0.4, 0.3);
  const double alone = ForceOfFins(fins, 0.0, 0.5).area_m2;
  EXPECT_DOUBLE_EQ(alone, 2.0 * FinLiftArea(fins, 0.5));
  // The body as wide as the fins are long: (1 + 1/2)².
  EXPECT_DOUBLE_EQ(ForceOfFins(fins, 0.3, 0.5).area_m2, 2.25 * alone);
}

// A triangle: its mean aerodynamic chord is two thirds of the root's, one third of the span out.
TEST(Fins, ActAtTheMeanAerodynamicChord) {
  FinSet fins = Rectangle(0.9, 0.6);
  fins.tip_chord_m = 0.0;
  fins.sweep_m = 0.9;
  EXPECT_NEAR(ForceOfFins(fins, 0.1, 0.5).station_m, 5.0 + 0.3 + 0.25 * 0.6, 1e-12);
  EXPECT_NEAR(ForceOfFins(fins, 0.1, 2.5).station_m, 5.0 + 0.3 + 0.5 * 0.6, 1e-12);
}

TEST(Fins, StripsAreIntegralsOfTheChord) {
  FinSet fins = Rectangle(0.7, 0.4);
  fins.tip_chord_m = 0.25;
  double first = 0.0, second = 0.0;
  constexpr int kParts = 100000;
  for (int i = 0; i < kParts; ++i) {
    const double part = (i + 0.5) / kParts, y = 0.2 + 0.4 * part;
    const double area = (0.7 - 0.45 * part) * 0.4 / kParts;
    first += area * y;
    second += area * y * y;
  }
  const FinStrips strips = StripsOf(fins, 0.2);
  EXPECT_NEAR(strips.first_m3, first, 1e-10);
  EXPECT_NEAR(strips.second_m4, second, 1e-10);
}

TEST(Fins, MoveTheCentreOfPressureAft) {
  Vehicle vehicle;
  Stage stage;
  stage.diameter_m = 0.2;
  stage.bottom_station_m = 3.0;
  vehicle.profile = {{ProfileShape::kTangentOgive, 0.6, 0.2}, {ProfileShape::kCylinder, 2.4, 0.2}};
  vehicle.stages = {stage};
  const AeroTable bare = BuildAerodynamics(vehicle)[0];
  FinSet fins = Rectangle(0.3, 0.2);
  fins.leading_edge_station_m = 2.7;
  fins.thickness_m = 0.005;
  vehicle.stages[0].fins = {fins};
  const AeroTable finned = BuildAerodynamics(vehicle)[0];
  EXPECT_LT(bare.xcp_station_m[0], 0.5);
  EXPECT_GT(finned.xcp_station_m[0], 2.0);
  // Slopes at Mach 0 add up: 2 of the nose, and the fins'.
  const double slope = finned.cn[1] / finned.incidence_rad[1];
  EXPECT_NEAR(slope, bare.cn[1] / bare.incidence_rad[1] + ForceOfFins(fins, 0.1, 0.0).area_m2 / (0.01 * kPi),
              0.01 * slope);
  for (std::size_t mach = 0; mach < finned.mach.size(); ++mach) {
    EXPECT_GT(finned.ca[mach * finned.incidence_rad.size()], bare.ca[mach * bare.incidence_rad.size()]);
    EXPECT_LT(finned.clp_per_rad[mach], 10.0 * bare.clp_per_rad[mach]);
    EXPECT_LT(finned.cmq_per_rad[mach], bare.cmq_per_rad[mach]);
  }
  // A stage that burns again is one body with one set, in either burn.
  vehicle.stages.push_back(vehicle.stages[0]);
  vehicle.stages[1].restarts = true;
  for (const AeroTable& table : BuildAerodynamics(vehicle)) {
    EXPECT_EQ(table.cn, finned.cn);
    EXPECT_EQ(table.ca, finned.ca);
    EXPECT_EQ(table.clp_per_rad, finned.clp_per_rad);
  }
}

}  // namespace
}  // namespace dispersa::vehicle_fins_test
