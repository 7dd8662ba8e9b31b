// Spent stages and lost flights of the shipped vehicle, from separation or loss to the ground.
#include "core/impact/impact_points.h"

#include "core/campaign_yaml/load.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/test.h"

namespace dispersa::impact_points_test {
namespace {

double Distance(const Geodetic& a, const Geodetic& b) {
  return (FromGeodetic(Wgs84(), a) - FromGeodetic(Wgs84(), b)).norm();
}

std::vector<ImpactPoint> Points(const CampaignFlights& flights, std::uint64_t index) {
  return FlyToImpact(flights, {index}, 1, [](const CaseResult&) {});
}

// The last tick before each separation shows the stage still attached: letting it fall from there, at its own
// centre of gravity, leads to the same place. `full` disperses winds, density, centres of gravity and tip-off
// rates.
TEST(ImpactPoints, ASpentStageFallsFromWhereTheFlightLeftIt) {
  const Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/full.yaml");
  const CampaignFlights flights(campaign);
  const Vehicle& vehicle = campaign.vehicle;
  for (const std::uint64_t index : {0u, 3u}) {
    std::vector<TickSample> last(4);
    FlightOptions options;
    options.case_index = index;
    options.observe = [&](const TickSample& sample) {
      last[static_cast<std::size_t>(sample.stack)] = sample;
    };
    const FlightInputs inputs = flights.Draw(index);
    ASSERT_EQ(dispersa::Fly(flights.model(), inputs, options).outcome, Outcome::kCompleted);
    const std::vector<ImpactPoint> points = Points(flights, index);
    ASSERT_EQ(points.size(), 3u);  // the fourth stage is in orbit
    const LauncherPlant plant = flights.model().PlantFor(inputs);
    for (std::size_t stage = 0; stage < 3; ++stage) {
      const ImpactPoint& point = points[stage];
      EXPECT_EQ(point.stage, static_cast<int>(stage) + 1);
      EXPECT_FALSE(point.lost);
      ASSERT_TRUE(point.impact);
      double dry_station_m = 0.0;
      for (const MassElement& each : vehicle.stages[stage].structure)
        dry_station_m += each.fraction * 0.5 * (each.top_station_m + each.bottom_station_m);
      // Up to separation it moves with the stack; alone and tumbling it would brake with 12 g at once.
      RigidBodyState stack = last[stage].state;
      const double left_s = point.from_time_s - last[stage].time_s;
      const BodyLoads& loads = last[stage].instant.loads;
      const Vector3 acceleration = Gravitation(plant.environment.earth, stack.p_EoC_I) +
                                   Rotate(stack.q_IB, loads.force_n / loads.mass_kg);
      stack.p_EoC_I += left_s * stack.v_IC_I + 0.5 * left_s * left_s * acceleration;
      stack.v_IC_I += left_s * acceleration;
      const RigidBodyState spent =
          AtPoint(stack, Vector3(last[stage].instant.cg_station_m - dry_station_m, 0.0, 0.0));
      const double length_m =
          vehicle.stages[stage].bottom_station_m - vehicle.stages[stage + 1].bottom_station_m;
      const auto expected = Fall(plant.environment,
                                 {DryMass(vehicle, static_cast<int>(stage)),
                                  TumblingCylinderDragArea(length_m, vehicle.stages[stage].diameter_m)},
                                 {point.from_time_s, spent.p_EoC_I, spent.v_IC_I});
      ASSERT_TRUE(expected);
      EXPECT_GT(point.from_time_s, last[stage].time_s - 1e-9);
      EXPECT_LT(point.from_time_s, last[stage].time_s + 0.03);
      // The drawn factor of the centre of gravity shifts the stack above by decimetres: times the turning
      // rate, over minutes of fall, metres.
      EXPECT_LT(Distance(point.impact->place, expected->place), 5.0) << index << " " << stage;
    }
  }
}

// The last tick with them shows where each is: four at their places, and the same four all alike as one on
// the axis. Those with tanks fall with what these have left, 20 kg on the bottoms.
TEST(ImpactPoints, BoostersFallFromTheirPlaces) {
  Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
  Boosters& b = campaign.vehicle.boosters;
  b = {4, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {22.0, 24.05, 0.6, 0.2}, 0.503};
  b.motor.thrust_n = 80e3;
  b.motor.burning_time_s = 30.0;
  campaign.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  for (const auto& [apart, liquid] : {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
    b.angles_rad = {};
    if (apart) b.angles_rad = {0.5, 0.5 + 0.5 * kPi, 0.5 + kPi, 0.5 + 1.5 * kPi};
    double body_kg = 150.0, body_m = 23.75;
    if (liquid) {
      if (!b.is_liquid()) MakeLiquid(b);
      const double left_kg = b.motor.residual_mass_kg = 20.0;
      body_kg += left_kg;
      body_m *= 150.0;
      for (const Tank& tank : b.tanks) {
        const double kg = left_kg * tank.propellant_mass_kg / b.propellant_mass_kg;
        body_m += kg * (tank.bottom_station_m - 0.5 * kg / (tank.density_kg_m3 * kPi * 0.09));
      }
      body_m /= body_kg;
    }
    const CampaignFlights flights(campaign);
    TickSample last;
    FlightOptions options;
    options.case_index = 0;
    options.observe = [&](const TickSample& s) {
      if (s.stack == 0 && (s.jettisoned & kBoostersGone) == 0) last = s;
    };
    dispersa::Fly(flights.model(), flights.Draw(0), options);
    std::vector<ImpactPoint> fallen;
    for (const ImpactPoint& point : Points(flights, 0))
      if (point.stage == 0) fallen.push_back(point);
    ASSERT_EQ(fallen.size(), 4u);
    const LauncherPlant plant = flights.model().PlantFor(flights.Draw(0));
    for (std::size_t k = 0; k < fallen.size(); ++k) {
      const double left_s = fallen[k].from_time_s - last.time_s;
      EXPECT_GE(left_s, -1e-9);
      EXPECT_LT(left_s, 0.01 + 1e-9);
      RigidBodyState stack = last.state;
      const Vector3 acceleration =
          Gravitation(plant.environment.earth, stack.p_EoC_I) +
          Rotate(stack.q_IB, last.instant.loads.force_n / last.instant.loads.mass_kg);
      stack.p_EoC_I += left_s * stack.v_IC_I + 0.5 * left_s * left_s * acceleration;
      stack.v_IC_I += left_s * acceleration;
      const double angle_rad = (apart ? 0.5 : 0.0) + 0.5 * kPi * static_cast<double>(k);
      const double y = 0.97 * std::cos(angle_rad), z = 0.97 * std::sin(angle_rad);
      const RigidBodyState spent = AtPoint(stack, Vector3(last.instant.cg_station_m - body_m, y, z));
      const auto expected = Fall(plant.environment, {body_kg, TumblingCylinderDragArea(5.5, 0.62)},
                                 {fallen[k].from_time_s, spent.p_EoC_I, spent.v_IC_I});
      ASSERT_TRUE(expected && fallen[k].impact);
      // The state's roundings and the case's own offsets of the centre of gravity, times the fall.
      EXPECT_LT(Distance(fallen[k].impact->place, expected->place), 0.3) << k;
      EXPECT_NEAR(fallen[k].impact->time_s, expected->time_s, 0.01);
    }
  }
}

TEST(ImpactPoints, ALostFlightFallsFromItsEnd) {
  Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml");
  for (Dispersion& dispersion : campaign.dispersions) {  // a stage 2 that nothing can hold
    if (dispersion.name.find("misalignment") == std::string::npos ||
        dispersion.name.find("stage2") == std::string::npos ||
        dispersion.name.find("clock") != std::string::npos)
      continue;
    dispersion.distribution = {};
    dispersion.distribution.values = {0.5};
  }
  const CampaignFlights flights(campaign);
  const CaseResult result = flights.FlyCase(2);
  ASSERT_EQ(result.outcome, Outcome::kLostControl) << result.reason;
  const std::vector<ImpactPoint> points = Points(flights, 2);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_FALSE(points[0].lost);
  EXPECT_EQ(points[0].stage, 1);
  EXPECT_TRUE(points[1].lost);
  EXPECT_EQ(points[1].stage, 2);
  EXPECT_EQ(points[1].from_time_s, result.end_time_s);
  ASSERT_TRUE(points[1].impact);
  EXPECT_GT(points[1].impact->time_s, result.end_time_s);
  EXPECT_GT(points[1].impact->peak_altitude_m, points[1].from_altitude_m);
  EXPECT_NEAR(points[1].impact->place.altitude_m, 0.0, 1e-5);

  // The falling body is the stack with its mass at that time, from where the flight ended.
  TickSample last;
  FlightOptions options;
  options.case_index = 2;
  options.observe = [&](const TickSample& sample) { last = sample; };
  const FlightResult again = dispersa::Fly(flights.model(), flights.Draw(2), options);
  const Stage& second = campaign.vehicle.stages[1];
  const auto expected =
      Fall(flights.model().PlantFor(flights.Draw(2)).environment,
           {last.instant.loads.mass_kg, TumblingCylinderDragArea(second.bottom_station_m, second.diameter_m)},
           {again.end_time_s, again.end_state.p_EoC_I, again.end_state.v_IC_I});
  ASSERT_TRUE(expected);
  // Within a tick it burns a ten-thousandth of its mass.
  EXPECT_LT(Distance(points[1].impact->place, expected->place), 20.0);
}

TEST(ImpactPoints, AreTheSameForAnyNumberOfThreads) {
  const CampaignFlights flights(LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml"));
  const std::vector<std::uint64_t> cases = {0, 1, 2, 5, 9};
  const auto one = FlyToImpact(flights, cases, 1, [](const CaseResult&) {});
  const auto three = FlyToImpact(flights, cases, 3, [](const CaseResult&) {});
  ASSERT_EQ(one.size(), 15u);
  ASSERT_EQ(three.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].case_index, three[i].case_index);
    EXPECT_EQ(one[i].impact->place.longitude_rad, three[i].impact->place.longitude_rad);
  }
}

}  // namespace
}  // namespace dispersa::impact_points_test
