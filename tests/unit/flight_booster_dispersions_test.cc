// Dispersed boosters: thrust, flow and burn times, and the vehicle's mass at every tick. The sample vehicle
// with two boosters flies in almost no air.
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_booster_dispersions_test {

constexpr double kBoostTime_s = 20.0, kBoostPropellant_kg = 500.0, kBoostDry_kg = 100.0,
                 kBoostThrust_n = 60e3;
constexpr double kBoostersWhole_kg = 2.0 * (kBoostPropellant_kg + kBoostDry_kg);
constexpr double kCoreFlow_kg_s = 100.0, kBoostFlow_kg_s = 2.0 * kBoostPropellant_kg / kBoostTime_s;

FlightDefinition Boosted() {
  FlightDefinition definition = HighDefinition();
  Boosters& b = definition.vehicle.boosters;
  b = {2, kBoostDry_kg, kBoostPropellant_kg, 0.9, 0.5, 14.0, 19.0, 19.2, {}, {15.0, 18.0, 0.48, 0.2}, 0.5};
  b.motor.thrust_n = kBoostThrust_n;
  b.motor.burning_time_s = kBoostTime_s;
  b.motor.nozzle_exit_area_m2 = 0.07;
  definition.vehicle.stages[0].liftoff_mass_kg += kBoostersWhole_kg;
  return definition;
}

// Inputs of the first stage that act on its boosters. The last one changes the masses too.
std::vector<FlightInputs> Dispersed() {
  FlightInputs thrust, flow, impulse, all;
  thrust.stages[0].thrust_factor = 1.03;
  flow.stages[0].mass_flow_factor = 0.95;
  impulse.stages[0].specific_impulse_factor = 1.01;
  all.stages[0].thrust_factor = 0.98;
  all.stages[0].mass_flow_factor = 1.04;
  all.stages[0].specific_impulse_factor = 0.99;
  all.stages[0].dry_mass_factor = 1.02;
  all.stages[0].propellant_factor = 0.97;
  all.stages[1].dry_mass_factor = 1.05;
  return {{}, thrust, flow, impulse, all};
}
double ThrustFactor(const FlightInputs& in) {
  return in.stages[0].thrust_factor * in.stages[0].specific_impulse_factor;
}

TEST(BoosterDispersions, FollowTheFirstStagesThrustAndFlow) {
  const FlightModel model(Boosted());
  for (const FlightInputs& in : Dispersed()) {
    const MotorBurn burn = model.PlantFor(in).boosters->burn;
    EXPECT_NEAR(burn.vacuum_thrust_n, 2.0 * kBoostThrust_n * ThrustFactor(in), 1e-8);
    EXPECT_NEAR(burn.full_flow_kg_s, kBoostFlow_kg_s * in.stages[0].mass_flow_factor, 1e-12);
    EXPECT_NEAR(burn.duration_s, kBoostTime_s / in.stages[0].mass_flow_factor, 1e-12);
    EXPECT_EQ(burn.propellant_mass_kg, 2.0 * kBoostPropellant_kg);
    EXPECT_NEAR(burn.exit_area_m2, 0.14, 1e-15);
  }
}

// The first stage without its boosters, as the flight's masses are: dry, propellant, and what is above.
struct Core {
  double dry_kg, propellant_kg, above_kg;
  explicit Core(const FlightInputs& in)
      : dry_kg(6000.0 * in.stages[0].dry_mass_factor),
        propellant_kg(4000.0 * in.stages[0].propellant_factor),
        above_kg(2000.0 * in.stages[1].dry_mass_factor + 1000.0) {}
};

// Every kilogram is accounted for until the core's burnout: what flows, and the shells when they go.
TEST(BoosterDispersions, MassIsWhatHasNotFlownNorLeft) {
  const FlightModel model(Boosted());
  for (const FlightInputs& in : Dispersed()) {
    const Core core(in);
    const double flow = in.stages[0].mass_flow_factor, boost_s = kBoostTime_s / flow;
    double gone_s = 0.0;
    int boosting = 0, alone = 0;
    FlightOptions options;
    options.observe = [&](const TickSample& s) {
      if (s.stack != 0 || !s.burning) return;
      const double full_kg = core.dry_kg + core.propellant_kg + core.above_kg + kBoostersWhole_kg;
      const double flown_kg =
          flow * (kCoreFlow_kg_s * s.time_s + kBoostFlow_kg_s * std::min(s.time_s, boost_s));
      const double mass_kg = s.instant.loads.mass_kg;
      const bool with_shells = std::fabs(mass_kg - (full_kg - flown_kg)) < 1e-6;
      if (with_shells) {
        ++boosting;
      } else {
        ASSERT_NEAR(mass_kg, full_kg - flown_kg - 2.0 * kBoostDry_kg, 1e-6) << s.time_s;
        if (gone_s == 0.0) gone_s = s.time_s;
        ++alone;
      }
      const double push_n = ThrustFactor(in) * (200e3 + (s.time_s < boost_s ? 2.0 * kBoostThrust_n : 0.0));
      if (std::fabs(s.time_s - boost_s) > 0.011) {
        EXPECT_NEAR(s.instant.thrust_n, push_n, 1e-2) << s.time_s;
      }
    };
    Fly(model, in, options);
    EXPECT_GT(boosting, 1800);
    EXPECT_GT(alone, 1500);
    // Detected within a tick or two, then the delay.
    EXPECT_NEAR(gone_s, boost_s + 0.5, 0.021);
  }
}

// Boosters' masses have no dispersions: a dispersed stage leaves them, and the stacks above, as they are.
TEST(BoosterDispersions, MassesOfTheBoostersStay) {
  const FlightModel model(Boosted());
  const FlightInputs in = Dispersed().back();
  const LauncherPlant plant = model.PlantFor(in), nominal = model.PlantFor({});
  EXPECT_EQ(plant.boosters->empty.mass_kg, 2.0 * kBoostDry_kg);
  EXPECT_EQ(plant.boosters->empty.first_moment_kg_m, nominal.boosters->empty.first_moment_kg_m);
  const Core core(in);
  const double propellant_kg = 1234.0;
  EXPECT_NEAR(MassesOn(plant, 0, kBoostersGone, propellant_kg, 30.0).mass_kg,
              core.dry_kg + core.above_kg + propellant_kg, 1e-8);
  EXPECT_NEAR(MassesOn(plant, 1, kBoostersGone, 1000.0, 0.0).mass_kg, core.above_kg, 1e-8);
}

}  // namespace dispersa::flight_booster_dispersions_test
