// Liquid stages: masses of draining tanks against slices of the liquid, burns with throttle, cut-off and
// depletion against closed forms, and mistakes.
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/modes/load_table.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/burning_stack.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"
#include "core/vehicle/vehicle_figures.h"
#include "tests/liquid_stage.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_liquid_test {
namespace {

// 4000 kg at 100 kg/s, of which 40 kg stay.
Vehicle LiquidVehicle() {
  Vehicle vehicle = SampleVehicle();
  MakeLiquid(vehicle.stages[0]);
  vehicle.stages[0].motor.residual_mass_kg = 40.0;
  return vehicle;
}

// The liquids in slices, about the axis and about a station across it.
struct Slices {
  double mass_kg = 0.0, first_kg_m = 0.0, second_kg_m2 = 0.0;
};
Slices Sliced(const Stage& stage, double propellant_kg) {
  Slices sum;
  for (const Tank& tank : stage.tanks) {
    const double mass_kg = propellant_kg * tank.propellant_mass_kg / stage.propellant_mass_kg;
    const double height_m = mass_kg / tank.density_kg_m3 / (0.25 * kPi * Square(tank.diameter_m));
    constexpr int kParts = 2000;
    for (int i = 0; i < kParts; ++i) {
      const double x = tank.bottom_station_m - height_m * (i + 0.5) / kParts, dm = mass_kg / kParts;
      sum.mass_kg += dm;
      sum.first_kg_m += dm * x;
      sum.second_kg_m2 += dm * (x * x + Square(height_m / kParts) / 12.0 + Square(tank.diameter_m) / 16.0);
    }
  }
  return sum;
}

TEST(DrainingTanks, HaveTheMomentsOfTheirLiquidsAtEveryLevel) {
  const Vehicle vehicle = LiquidVehicle();
  const StackMass stack = BuildStackMasses(vehicle)[0];
  for (const double propellant_kg : {4000.0, 2900.0, 1111.0, 40.0, 0.0}) {
    const Slices liquid = Sliced(vehicle.stages[0], propellant_kg);
    const double mass_kg = stack.fixed_mass_kg + liquid.mass_kg;
    const double cg_m = (stack.fixed_first_moment_kg_m + liquid.first_kg_m) / mass_kg;
    const MassProperties m = stack.At(propellant_kg);
    EXPECT_NEAR(m.mass_kg, mass_kg, 1e-9);
    EXPECT_NEAR(m.cg_station_m, cg_m, 1e-9);
    EXPECT_NEAR(m.transverse_inertia_kg_m2,
                stack.fixed_second_moment_kg_m2 + liquid.second_kg_m2 - mass_kg * cg_m * cg_m, 1e-5);
    EXPECT_EQ(m.axial_inertia_kg_m2, stack.fixed_axial_inertia_kg_m2)
        << "a smooth wall does not turn the liquid";
    EXPECT_EQ(m.axial_inertia_per_kg, 0.0);
  }
}

// One cylinder alone: half the liquid stands half as high, on the same bottom.
TEST(DrainingTanks, OfOneCylinderAreTheTextbooks) {
  Vehicle vehicle = LiquidVehicle();
  Stage& stage = vehicle.stages[0];
  stage.tanks = {{"all", 10.0, 18.0, 1.0, 4000.0, 4000.0 / (0.25 * kPi * 6.4)}};  // 6.4 m high
  const StackMass stack = BuildStackMasses(vehicle)[0];
  const auto liquid_cg = [&](double kg) {
    const MassProperties m = stack.At(kg);
    return (m.mass_kg * m.cg_station_m - stack.fixed_first_moment_kg_m) / kg;
  };
  EXPECT_NEAR(liquid_cg(4000.0), 18.0 - 3.2, 1e-12);
  EXPECT_NEAR(liquid_cg(2000.0), 18.0 - 1.6, 1e-12);
  const MassProperties m = stack.At(2000.0);
  const double about_zero = m.transverse_inertia_kg_m2 + m.mass_kg * Square(m.cg_station_m);
  EXPECT_NEAR(about_zero - stack.fixed_second_moment_kg_m2,
              2000.0 * (Square(16.4) + Square(3.2) / 12.0 + Square(1.0) / 16.0), 1e-6);
}

TEST(DrainingTanks, DerivativesAreThoseOfTheMoments) {
  const Vehicle vehicle = LiquidVehicle();
  const StackMass stack = BuildStackMasses(vehicle)[0];
  for (const double kg : {3800.0, 1500.0, 200.0}) {
    const double h = 1.0;
    const auto slope = [&](double MassProperties::*of) {
      return (stack.At(kg + h).*of - stack.At(kg - h).*of) / (2.0 * h);
    };
    const MassProperties m = stack.At(kg);
    EXPECT_NEAR(m.transverse_inertia_per_kg, slope(&MassProperties::transverse_inertia_kg_m2), 1e-5);
    EXPECT_NEAR(slope(&MassProperties::cg_station_m), (m.source_station_m - m.cg_station_m) / m.mass_kg,
                1e-9);
  }
}

// Of a stage above, they are full; the beam's masses are the same.
TEST(DrainingTanks, AreFullInAStageThatWaitsAndTheSameAlongTheBeam) {
  Vehicle vehicle = SampleVehicle();
  MakeLiquid(vehicle.stages[1]);
  const Slices liquid = Sliced(vehicle.stages[1], 1000.0);
  const StackMass whole = BuildStackMasses(vehicle)[0], upper = BuildStackMasses(vehicle)[1];
  const Vehicle with_grains = SampleVehicle();
  const StackMass solid = BuildStackMasses(with_grains)[0];
  const double grain_m = 7.5, grain_kg = 1000.0;
  EXPECT_NEAR(whole.fixed_first_moment_kg_m,
              solid.fixed_first_moment_kg_m - grain_kg * grain_m + liquid.first_kg_m, 1e-6);
  EXPECT_NEAR(whole.fixed_mass_kg, solid.fixed_mass_kg, 1e-9);
  EXPECT_NEAR(upper.At(1000.0).mass_kg * upper.At(1000.0).cg_station_m - upper.fixed_first_moment_kg_m,
              liquid.first_kg_m, 1e-6);
  for (const double kg : {1000.0, 321.0}) {
    double mass_kg = 0.0, first_kg_m = 0.0;
    for (const SpreadMass& m : BuildBeamMasses(vehicle, 1, kg).spread) {
      const double length_m = m.bottom_station_m - m.top_station_m,
                   middle_m = 0.5 * (m.top_station_m + m.bottom_station_m);
      mass_kg += length_m * m.MassPerLength(middle_m);
      first_kg_m += length_m * m.MassPerLength(middle_m) * middle_m;
    }
    EXPECT_NEAR(mass_kg, upper.At(kg).mass_kg, 1e-9);
    EXPECT_NEAR(first_kg_m, upper.At(kg).mass_kg * upper.At(kg).cg_station_m, 1e-6);
  }
}

MotorBurn BurnWith(const std::function<void(Motor&)>& change, double thrust = 1.0, double flow = 1.0) {
  Stage stage = LiquidVehicle().stages[0];
  change(stage.motor);
  return BuildBurn(stage, thrust, flow);
}

// The propellant left falls by the integral of the flow. Levels are linear between the steps, so the midpoint
// rule is exact.
void ExpectFlowToFit(const MotorBurn& burn) {
  const int steps = 2000;
  const double step_s = burn.duration_s / steps;
  std::vector<double> ends = burn.Kinks(0.0);
  ends.push_back(burn.duration_s);
  double at_s = 0.0, left_kg = burn.propellant_mass_kg;
  for (const double end_s : ends) {
    while (at_s < end_s) {
      const double next_s = std::min(at_s + step_s, end_s);
      left_kg -= (next_s - at_s) * burn.full_flow_kg_s * burn.Fraction(0.5 * (at_s + next_s));
      at_s = next_s;
      ASSERT_NEAR(burn.Propellant(at_s), left_kg, 1e-7) << at_s;
    }
  }
  EXPECT_NEAR(left_kg, burn.left_kg, 1e-7);
}

TEST(LiquidBurn, EndsWhenAllButTheResidualHasFlown) {
  const MotorBurn burn = BurnWith([](Motor&) {});
  EXPECT_DOUBLE_EQ(burn.duration_s, 39.6);
  EXPECT_EQ(burn.left_kg, 40.0);
  EXPECT_EQ(burn.Propellant(0.0), 4000.0);
  EXPECT_EQ(burn.Propellant(39.6), 40.0);
  EXPECT_EQ(burn.Fraction(39.6), 1.0);
  EXPECT_EQ(burn.Fraction(39.7), 0.0);
  EXPECT_TRUE(burn.Kinks(0.0).empty());
  ExpectFlowToFit(burn);
}

// 0 to full in 2 s, 30 s of it, down to 60 % in 4 s: 100, 3000 and 320 kg; 540 kg more at 60 kg/s.
TEST(LiquidBurn, FollowsItsThrottleAndHoldsTheLastLevel) {
  const auto throttled = [](Motor& m) { m.throttle = {{0.0, 2.0, 32.0, 36.0}, {0.0, 1.0, 1.0, 0.6}}; };
  const MotorBurn burn = BurnWith(throttled);
  EXPECT_NEAR(burn.duration_s, 36.0 + 540.0 / 60.0, 1e-12);
  EXPECT_EQ(burn.left_kg, 40.0);
  EXPECT_DOUBLE_EQ(burn.Fraction(1.0), 0.5);
  EXPECT_DOUBLE_EQ(burn.Fraction(34.0), 0.8);
  EXPECT_DOUBLE_EQ(burn.Fraction(40.0), 0.6);
  EXPECT_NEAR(burn.Propellant(2.0), 3900.0, 1e-9);
  EXPECT_NEAR(burn.Propellant(32.0), 900.0, 1e-9);
  EXPECT_NEAR(burn.Propellant(34.0), 720.0, 1e-9);
  EXPECT_EQ(burn.Kinks(1.0), (std::vector<double>{3.0, 33.0, 37.0}));
  ExpectFlowToFit(burn);
  // A flow of 1.1 empties the tanks earlier, and commands come when they come.
  const MotorBurn faster = BurnWith(throttled, 1.05, 1.1);
  EXPECT_EQ(faster.Kinks(1.0), burn.Kinks(1.0));
  EXPECT_NEAR(faster.duration_s, 36.0 + (3960.0 - 1.1 * 3420.0) / 66.0, 1e-9);
  EXPECT_DOUBLE_EQ(faster.vacuum_thrust_n, 210e3);
  ExpectFlowToFit(faster);
}

// Depletion within the last ramp: 100 kg and 20 s of full flow leave 1860; l = 1 - t/40 from then on burns
// 100 (t - t²/80) = 1860.
TEST(LiquidBurn, RunsDryWithinARamp) {
  const MotorBurn burn = BurnWith([](Motor& m) {
    m.throttle = {{0.0, 2.0, 22.0, 62.0}, {0.0, 1.0, 1.0, 0.0}};
  });
  EXPECT_NEAR(burn.duration_s, 22.0 + 40.0 * (1.0 - std::sqrt(1.0 - 2.0 * 18.6 / 40.0)), 1e-9);
  EXPECT_EQ(burn.left_kg, 40.0);
  EXPECT_EQ(burn.Propellant(burn.duration_s), 40.0);
  ExpectFlowToFit(burn);
}

TEST(LiquidBurn, EndsByCommandAndKeepsTheRest) {
  const auto by_time = [](Motor& m) {
    m.throttle = {{0.0, 10.0, 20.0}, {1.0, 1.0, 0.5}};
    m.cut_off = CutOff::kAtTime;
    m.cut_off_s = 16.0;
  };
  const MotorBurn burn = BurnWith(by_time);
  EXPECT_EQ(burn.duration_s, 16.0);
  EXPECT_NEAR(burn.left_kg, 4000.0 - 1000.0 - 100.0 * 6.0 * 0.85, 1e-9);
  EXPECT_DOUBLE_EQ(burn.Fraction(16.0), 0.7);
  ExpectFlowToFit(burn);
  // Dry before the command.
  const MotorBurn dry = BurnWith([](Motor& m) {
    m.cut_off = CutOff::kAtTime;
    m.cut_off_s = 50.0;
  });
  EXPECT_DOUBLE_EQ(dry.duration_s, 39.6);
  EXPECT_EQ(dry.left_kg, 40.0);
  // A throttle that closes.
  const MotorBurn closed = BurnWith([](Motor& m) { m.throttle = {{0.0, 20.0, 21.0}, {1.0, 1.0, 0.0}}; });
  EXPECT_EQ(closed.duration_s, 21.0);
  EXPECT_NEAR(closed.left_kg, 4000.0 - 2050.0, 1e-9);
  EXPECT_EQ(closed.Fraction(21.0), 0.0);
  ExpectFlowToFit(closed);
}

TEST(VehicleFigures, OfALiquidStageLeaveTheResidualAside) {
  Vehicle vehicle = LiquidVehicle();
  const StageFigures figures = FiguresOf(vehicle)[0];
  EXPECT_DOUBLE_EQ(figures.burning_time_s, 39.6);
  EXPECT_DOUBLE_EQ(figures.flow_kg_s, 100.0);
  EXPECT_NEAR(figures.specific_impulse_s, 2000.0 / 9.80665, 1e-9);
  EXPECT_NEAR(figures.ideal_delta_v_m_s, 2000.0 * std::log(13000.0 / 9040.0), 1e-9);
  EXPECT_NEAR(figures.burnout_load_g, 200e3 / (9040.0 * 9.80665), 1e-9);
  vehicle.stages[0].motor.throttle = {{0.0, 20.0, 30.0}, {1.0, 1.0, 0.5}};
  EXPECT_NEAR(FiguresOf(vehicle)[0].burnout_load_g, 200e3 / (11000.0 * 9.80665), 1e-9);
}

// The mass ahead of sections by their parabola over the propellant, at a level between those that it goes
// through, of what the whole liquid would make.
TEST(LoadTable, FollowsDrainingTanksWithinAFewPerCent) {
  const Vehicle vehicle = LiquidVehicle();
  const LoadTable table = [&] {
    Vehicle with_profile = vehicle;
    with_profile.profile = {{ProfileShape::kTangentOgive, 2.0, 1.2}, {ProfileShape::kCylinder, 18.0, 1.2}};
    return BuildLoadTable(with_profile, 0);
  }();
  for (const double part : {0.25, 0.75}) {
    const double kg = part * 4000.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(table.stations); ++i) {
      const double s = table.station_m[i];
      double first_kg_m = 0.0, full_kg_m = 0.0;
      for (const double of_kg : {kg, 4000.0}) {
        double sum = 0.0;
        for (const SpreadMass& m : BuildBeamMasses(vehicle, 0, of_kg).spread) {
          const double end = std::min(m.bottom_station_m, s);
          if (end <= m.top_station_m) continue;
          const double length_m = end - m.top_station_m;
          sum +=
              length_m * m.MassPerLength(0.5 * (m.top_station_m + end)) * (s - 0.5 * (m.top_station_m + end));
        }
        (of_kg == kg ? first_kg_m : full_kg_m) = sum;
      }
      const auto& f = table.first_kg_m[i];
      EXPECT_NEAR(f[0] + kg * (f[1] + kg * f[2]), first_kg_m, 0.03 * full_kg_m)
          << "station " << s << ", part " << part;
    }
  }
}

}  // namespace
}  // namespace dispersa::vehicle_liquid_test
