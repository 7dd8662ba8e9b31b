// Flights of liquid stages: a throttled burn in space gains the velocity of the rocket equation, for any
// throttle. Whole flights differ from those of solid motors as physics predicts.
#include "core/trajectory/ascent.h"
#include "tests/burn_in_space.h"
#include "tests/liquid_stage.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::liquid_flight_test {
namespace {

Vehicle LiquidVehicle() {
  Vehicle vehicle = Slv4Definition(DISPERSA_CAMPAIGNS).vehicle;
  MakeLiquid(vehicle.stages[0]);
  return vehicle;
}

// c ln(m0 / m1), of all that flows and of nothing else: throttle and cut-off decide m1, factors c.
TEST(LiquidFlight, GainsTheRocketEquationsSpeedWhateverTheThrottle) {
  Vehicle vehicle = LiquidVehicle();
  Stage& stage = vehicle.stages[0];
  stage.motor.residual_mass_kg = 0.015 * stage.propellant_mass_kg;
  const double exhaust_m_s = stage.motor.thrust_n * stage.motor.burning_time_s / stage.propellant_mass_kg;
  const LauncherPlant plant = PlantInEmptySpace(vehicle);
  const Throttle throttles[] = {{}, {{0.0, 1.3, 30.0, 33.3, 60.0}, {0.2, 1.0, 1.0, 0.55, 0.7}}};
  for (const Throttle& throttle : throttles) {
    for (const auto& [cut, tail_off_s] : {std::pair{false, 0.0}, {true, 0.0}, {true, 1.9}}) {
      stage.motor.throttle = throttle;
      stage.motor.tail_off_s = tail_off_s;
      stage.motor.cut_off = cut ? CutOff::kAtTime : CutOff::kAtDepletion;
      stage.motor.cut_off_s = 51.7;
      for (const auto& [thrust, flow] : {std::pair{1.0, 1.0}, {1.02, 0.97}}) {
        const MotorBurn burn = BuildBurn(stage, thrust, flow);
        const double left_kg = cut ? burn.left_kg : stage.motor.residual_mass_kg;
        const double exact_m_s =
            exhaust_m_s * thrust / flow *
            std::log(stage.liftoff_mass_kg / (stage.liftoff_mass_kg - stage.propellant_mass_kg + left_kg));
        const double coarse = std::fabs(SpeedGained(plant, stage, thrust, flow, 0.4) - exact_m_s);
        const double fine = std::fabs(SpeedGained(plant, stage, thrust, flow, 0.2) - exact_m_s);
        EXPECT_LT(fine, std::max(coarse / 12.0, 1e-8))
            << throttle.time_s.size() << " corners, " << (cut ? "cut off" : "to depletion");
        EXPECT_LT(fine, 1e-5);
      }
    }
  }
}

// Everything about the stage but where its mass is and goes is as before: the trajectory is nearly that of
// the solid stage; a residual costs what the rocket equation says of the mass that stays.
TEST(LiquidFlight, CarriesItsResidualAsDeadMass) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  const FlightResult solid = Fly(FlightModel(definition), {}, {});
  Stage& last = definition.vehicle.stages.back();
  MakeLiquid(last);
  const FlightResult full = Fly(FlightModel(definition), {}, {});
  const double residual_kg = 0.01 * last.propellant_mass_kg;
  last.motor.residual_mass_kg = residual_kg;
  const FlightResult less = Fly(FlightModel(definition), {}, {});
  ASSERT_EQ(solid.outcome, Outcome::kCompleted) << solid.reason;
  ASSERT_EQ(full.outcome, Outcome::kCompleted) << full.reason;
  ASSERT_EQ(less.outcome, Outcome::kCompleted) << less.reason;
  const std::size_t speed = MetricColumn("injection_velocity_m_s");
  EXPECT_NEAR(full.metrics[speed], solid.metrics[speed], 0.5);
  EXPECT_NE(full.digest, solid.digest);
  const double exhaust_m_s = last.motor.thrust_n * last.motor.burning_time_s / last.propellant_mass_kg;
  const double empty_kg = last.liftoff_mass_kg - last.propellant_mass_kg;
  const double lost_m_s = exhaust_m_s * std::log((empty_kg + residual_kg) / empty_kg);
  // Gravitation has a little less time, and the reaction control has taken a little mass.
  EXPECT_NEAR(full.metrics[speed] - less.metrics[speed], lost_m_s, 0.03 * lost_m_s);
  EXPECT_LT(less.end_time_s, full.end_time_s);
  EXPECT_NEAR(full.end_time_s - less.end_time_s, 0.01 * last.motor.burning_time_s, 1e-9);
}

// Half thrust at the end of stage 1 halves the load there. The 3DOF burns as long and leaves as much.
TEST(LiquidFlight, ThrottlesItsLoads) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  Stage& first = definition.vehicle.stages[0];
  MakeLiquid(first);
  // Of stage 1 alone: the later stages do not burn.
  const auto peak_g = [&] {
    History history;
    history.step_s = 0.1;
    FlightOptions options;
    options.history = &history;
    Fly(FlightModel(definition), {}, options);
    const int stage = FindHistoryColumn("stage"), thrust = FindHistoryColumn("thrust_n"),
              mass = FindHistoryColumn("mass_kg");
    double most = 0.0;
    for (std::size_t row = 0; row < history.rows(); ++row)
      if (history.at(row, stage) == 1.0)
        most = std::max(most, history.at(row, thrust) / history.at(row, mass) / kStandardGravity);
    return most;
  };
  const double burn_s = first.motor.burning_time_s;
  const double full_g = peak_g();
  first.motor.throttle = {{0.0, 0.5 * burn_s, 0.5 * burn_s + 1.0}, {1.0, 1.0, 0.5}};
  const double throttled_g = peak_g();
  const MotorBurn burn = BuildBurn(first, 1.0, 1.0);
  const double empty_kg = first.liftoff_mass_kg - first.propellant_mass_kg;
  EXPECT_NEAR(full_g, first.motor.thrust_n / empty_kg / kStandardGravity, 0.02);
  const double at_turn_kg = empty_kg + burn.Propellant(0.5 * burn_s);
  EXPECT_NEAR(
      throttled_g,
      std::max(first.motor.thrust_n / at_turn_kg, 0.5 * first.motor.thrust_n / empty_kg) / kStandardGravity,
      0.02);

  const AscentModel ascent = BuildAscentModel(definition.vehicle, definition.autopilot.tick_s);
  EXPECT_EQ(ascent.plant.stacks[0].burn.duration_s, burn.duration_s);
  EXPECT_EQ(ascent.plant.stacks[0].burn.left_kg, 0.0);
}

}  // namespace
}  // namespace dispersa::liquid_flight_test
