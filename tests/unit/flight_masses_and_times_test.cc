// Dispersed masses and delays change a vehicle and its timeline only in their own stage.
#include "core/dynamics/launcher.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/sequence.h"
#include "core/vehicle/mass.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_masses_and_times_test {
namespace {

constexpr double kTick_s = 0.01;

Vehicle Slv4() { return LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"); }
std::vector<MotorBurn> BurnsOf(const Vehicle& vehicle) {
  std::vector<MotorBurn> burns;
  for (const Stage& stage : vehicle.stages) burns.push_back(BuildBurn(stage, 1.0, 1.0));
  return burns;
}

TEST(Timeline, ASeparationDelayIsThatOfItsStage) {
  const Vehicle vehicle = Slv4();
  const std::vector<MotorBurn> burns = BurnsOf(vehicle);
  const std::vector<StageTimes> nominal = BuildTimeline(vehicle, burns, kTick_s, 500.0);
  for (std::size_t late = 0; late < 3; ++late) {
    FlightInputs in;
    in.stages[late].separation_delay_s = 0.25;
    const std::vector<StageTimes> times = BuildTimeline(vehicle, burns, kTick_s, 500.0, {}, in);
    for (std::size_t i = 0; i < 4; ++i) {
      // Stages up to it keep their burns, those behind it come later; stage 4 waits for its timer.
      const double burn_late_s = i > late && i < 3 ? 0.25 : 0.0;
      EXPECT_NEAR(times[i].ignition_s, nominal[i].ignition_s + burn_late_s, 1.01 * kTick_s) << late << i;
      const double separation_late_s = i >= late && i < 3 ? 0.25 : 0.0;
      EXPECT_NEAR(times[i].separation_s, nominal[i].separation_s + separation_late_s, 1.01 * kTick_s)
          << late << i;
    }
  }
}

// The flight computer sees a burnout at its next tick and counts from there; boosters leave before the stage
// does.
TEST(BoosterTimes, AreDetectedOnATickAndEndWithTheStage) {
  Boosters boosters;
  boosters.separation_delay_s = 0.5;
  MotorBurn burn;
  StageTimes stage;
  stage.ignition_s = -0.5;
  stage.burnout_s = 60.0;
  for (const auto& [duration_s, burnout_s, separation_s] :
       {std::array{30.5, 30.0, 30.5}, std::array{30.503, 30.003, 30.51}, std::array{30.5099, 30.0099, 30.51},
        std::array{60.2, 59.7, 60.0}, std::array{70.0, 60.0, 60.0}}) {
    burn.duration_s = duration_s;
    const BoosterTimes times = BuildBoosterTimes(boosters, burn, stage, kTick_s);
    EXPECT_NEAR(times.burnout_s, burnout_s, 1e-12) << duration_s;
    EXPECT_NEAR(times.separation_s, separation_s, 1e-9) << duration_s;
  }
}

// What a stage jettisons on its last burn is on board in all of them, and has no dispersed mass of its own.
TEST(DispersedVehicle, WhatARestartLetsGoOfIsPartOfEachBurnsMass) {
  Vehicle vehicle = Slv4();
  Stage again = vehicle.stages.back();
  again.restarts = true;
  Jettison body;
  body.mass_kg = 120.0;
  again.jettisoned = {body};
  vehicle.stages.back().jettisoned.clear();
  vehicle.stages.push_back(again);
  const std::size_t first = vehicle.stages.size() - 2;
  for (const std::size_t burn : {first, first + 1}) vehicle.stages[burn].liftoff_mass_kg += body.mass_kg;
  FlightInputs in;
  in.stages[first].dry_mass_factor = 1.1;
  const double dry_kg = DryMass(vehicle, static_cast<int>(first));
  const Vehicle heavier = WithDispersedMasses(vehicle, in);
  for (const std::size_t burn : {first, first + 1})
    EXPECT_NEAR(heavier.stages[burn].liftoff_mass_kg,
                1.1 * dry_kg + vehicle.stages[burn].propellant_mass_kg + body.mass_kg, 1e-9)
        << burn;
}

// A heavier charge burns longer at the same thrust: total impulse over propellant, the exhaust velocity,
// stays.
TEST(DispersedVehicle, AThrustCurveIsStretchedWithItsPropellant) {
  Vehicle vehicle = Slv4();
  ThrustCurve& curve = vehicle.stages[1].motor.thrust_curve;
  curve.time_s = {0.0, 10.0, 50.0, 54.0};
  curve.thrust_n = {250e3, 280e3, 240e3, 0.0};
  FlightInputs in;
  in.stages[1].propellant_factor = 1.004;
  const Vehicle heavier = WithDispersedMasses(vehicle, in);
  const MotorBurn before = BuildBurn(vehicle.stages[1], 1.0, 1.0),
                  after = BuildBurn(heavier.stages[1], 1.0, 1.0);
  EXPECT_NEAR(after.propellant_mass_kg, 1.004 * before.propellant_mass_kg, 1e-9);
  EXPECT_NEAR(after.duration_s, 1.004 * before.duration_s, 1e-9);
  EXPECT_NEAR(after.ExhaustVelocity(), before.ExhaustVelocity(), 1e-9 * before.ExhaustVelocity());
  EXPECT_NEAR(after.vacuum_thrust_n, before.vacuum_thrust_n, 1e-9 * before.vacuum_thrust_n);
}

// Boosters beside the first stage keep their masses when masses are dispersed.
TEST(DispersedVehicle, BoostersKeepTheirMasses) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_TEST_DATA "/goldens/boosters_vehicle.yaml");
  FlightInputs in;
  in.stages[1].dry_mass_factor = 1.01;
  const Vehicle heavier = WithDispersedMasses(vehicle, in);
  const double added_kg = 0.01 * DryMass(vehicle, 1);
  ASSERT_GT(added_kg, 1.0);
  EXPECT_NEAR(heavier.stages[0].liftoff_mass_kg, vehicle.stages[0].liftoff_mass_kg + added_kg, 1e-9);
  EXPECT_NEAR(heavier.stages[1].liftoff_mass_kg, vehicle.stages[1].liftoff_mass_kg + added_kg, 1e-9);
  EXPECT_EQ(heavier.stages[2].liftoff_mass_kg, vehicle.stages[2].liftoff_mass_kg);
  EXPECT_NEAR(DryMass(heavier, 0), DryMass(vehicle, 0), 1e-9);
}

}  // namespace
}  // namespace dispersa::flight_masses_and_times_test
