// Guidance over more than two burns, and bodies that leave at an altitude or a heat flux: its prediction
// against the engine's flight, and where its flights end.
#include "core/campaign/flight_definition.h"
#include "core/environment/atmosphere.h"
#include "core/environment/earth.h"
#include "core/flight/tick_sample.h"
#include "core/guidance/predictor.h"
#include "tests/gallery_launcher.h"
#include "tests/guidance_mission.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::guidance_sequence_test {
namespace {

// A burn of an open-loop flight: its first sample after `since_s`, and how long it lasts.
struct Burn {
  NavigatedState state;
  double ignition_s = 0.0, end_s = 0.0, expelled_kg = 0.0;
  bool seen = false;
};
void Watch(const TickSample& sample, int stack, double since_s, Burn& burn) {
  if (sample.stack != stack || !sample.burning) return;
  burn.end_s = sample.time_s;
  if (burn.seen || sample.since_ignition_s < since_s) return;
  burn.seen = true;
  burn.ignition_s = sample.time_s - sample.since_ignition_s;
  burn.state = {sample.time_s, sample.state.p_EoC_I, sample.state.v_IC_I};
  burn.expelled_kg = sample.expelled_mass_kg;
}

class CriterionDrop : public testing::TestWithParam<JettisonTrigger> {};

// Electron's fairing leaves at an altitude or a heat flux. A weak first stage comes there later than the
// reference.
TEST_P(CriterionDrop, IsPredictedWhereTheFlightMeetsIt) {
  FlightDefinition definition = DefinitionOf(GalleryLauncherWithoutTailOff(DISPERSA_CAMPAIGNS, "electron"));
  Jettison& fairing = definition.vehicle.stages[1].jettisoned.front();
  FlightOptions options;
  double at_m = 0.0, flux_w_m2 = 0.0;
  definition.guidance.closed_loop = false;
  options.observe = [&](const TickSample& sample) {
    if (sample.time_s > fairing.threshold) return;
    at_m = ToGeodetic(Wgs84(), InertialToEarth(Wgs84(), sample.time_s, sample.state.p_EoC_I)).altitude_m;
    const Vector3 turns(0.0, 0.0, Wgs84().rotation_rate_rad_s);
    flux_w_m2 = 0.5 * StandardAtmosphere1976(at_m).density_kg_m3 *
                std::pow((sample.state.v_IC_I - turns.cross(sample.state.p_EoC_I)).norm(), 3);
  };
  Fly(FlightModel(definition), {}, options);
  fairing.trigger = GetParam();
  fairing.threshold = fairing.trigger == JettisonTrigger::kAtAltitude ? at_m : flux_w_m2;
  FlightInputs inputs;
  inputs.stages[0].thrust_factor = 0.97;
  Burn burn;
  double left_s = 0.0;
  options.observe = [&](const TickSample& sample) {
    Watch(sample, 1, 10.0, burn);
    if (left_s == 0.0 && (sample.jettisoned & 1u) != 0u) left_s = sample.time_s;
  };
  const FlightResult flown = Fly(FlightModel(definition), inputs, options);
  ASSERT_EQ(flown.outcome, Outcome::kCompleted);
  ASSERT_TRUE(burn.seen);
  // A slower flight meets a heat flux less late than an altitude.
  EXPECT_GT(left_s, definition.jettison_s[0] + 1.0);
  ASSERT_LT(burn.state.time_s, definition.jettison_s[0]);

  definition.guidance.closed_loop = true;
  const FlightModel closed(definition);
  const GuidanceMission& mission = *closed.guidance_mission();
  const PlanPrior prior = BuildPrior(mission);
  const Knowledge known = KnowledgeInLastBurn(mission, burn.ignition_s, burn.expelled_kg);
  Plan plan = prior.nominal;
  plan.value[kCutOff] = flown.end_time_s - burn.ignition_s;
  const Injection predicted = Predict(mission, prior, known, burn.state, plan);
  Knowledge by_time = known;
  for (MassDrop& drop : by_time.last.drops)
    if (drop.waits()) drop.time_s = definition.jettison_s[0];
  const Injection wrong = Predict(mission, prior, by_time, burn.state, plan);
  const double flown_m_s = MetricOf(flown, "injection_velocity_m_s");
  std::printf(
      "%s: the fairing leaves %.2f s after the reference's; predicted less flown: %.4f m/s, %.2f m; with "
      "the reference's time %.4f m/s\n",
      GetParam() == JettisonTrigger::kAtAltitude ? "altitude" : "heat flux",
      left_s - definition.jettison_s[0], predicted.at.velocity_m_s - flown_m_s,
      predicted.at.altitude_m - 1e3 * MetricOf(flown, "injection_altitude_km"),
      wrong.at.velocity_m_s - flown_m_s);
  EXPECT_NEAR(predicted.at.velocity_m_s, flown_m_s, 0.15);
  EXPECT_GT(std::fabs(wrong.at.velocity_m_s - flown_m_s), 0.5);
  // The end is a smooth function of the plan: its second difference is that of a curve, not of a jump.
  const auto speed_at = [&](double pitch_rad) {
    Plan turned = plan;
    turned.value[kPitchMiddle] = pitch_rad;
    return Predict(mission, prior, known, burn.state, turned).at.velocity_m_s;
  };
  const double step = 1e-3 * kRadPerDeg * 5.0;
  const double slope_low = (speed_at(0.0) - speed_at(-step)) / step,
               slope_high = (speed_at(step) - speed_at(0.0)) / step;
  EXPECT_NEAR(slope_low, slope_high, 1e-2 * std::fmax(std::fabs(slope_low), 100.0));

  const FlightResult guided = Fly(closed, inputs);
  EXPECT_EQ(MetricOf(guided, "guidance_converged"), 1.0);
  EXPECT_LT(std::fabs(MetricOf(guided, "semi_major_axis_error_km")), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Electron, CriterionDrop,
                         testing::Values(JettisonTrigger::kAtAltitude, JettisonTrigger::kAtHeatFlux),
                         [](const auto& trigger) {
                           return std::string(trigger.param == JettisonTrigger::kAtAltitude ? "Altitude"
                                                                                            : "HeatFlux");
                         });

// Vega from its third burn on: through that, a coast, the fourth, a long coast and the fifth.
TEST(ThreeBurns, ArePredictedAsTheEngineFliesThem) {
  FlightDefinition definition = DefinitionOf(GalleryLauncherWithoutTailOff(DISPERSA_CAMPAIGNS, "vega"));
  definition.guidance.burns = 3;
  // Guidance knows no bending: with it the altitude is 310 m off.
  definition.vehicle.structure_beam.reset();
  const FlightModel closed(definition);
  definition.guidance.closed_loop = false;
  Burn third, fourth, fifth;
  FlightOptions options;
  options.observe = [&](const TickSample& sample) {
    Watch(sample, 2, 30.0, third);
    Watch(sample, 3, 0.0, fourth);
    Watch(sample, 4, 0.0, fifth);
  };
  const FlightResult flown = Fly(FlightModel(definition), {}, options);
  const GuidanceMission& mission = *closed.guidance_mission();
  ASSERT_EQ(mission.earlier.size(), 1u);
  PlanPrior prior = BuildPrior(mission);
  SetEarlier(mission.earlier[0].stage, prior);
  Knowledge known;
  known.phase = GuidancePhase::kEarlierBurns;
  known.burn_ignition_s = third.ignition_s;
  known.below = mission.earlier[0].stage;
  known.below.ignition_mass_kg -= third.expelled_kg;
  known.expelled_kg = third.expelled_kg;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value[kBelowCutOff] = fourth.end_s + 0.5 * definition.autopilot.tick_s - fourth.ignition_s;
  plan.value[kIgnition] = fifth.ignition_s;
  plan.value[kCutOff] = flown.end_time_s - fifth.ignition_s;
  const Injection predicted = Predict(mission, prior, known, third.state, plan);
  const double altitude_m = predicted.at.altitude_m - 1e3 * MetricOf(flown, "injection_altitude_km"),
               velocity_m_s = predicted.at.velocity_m_s - MetricOf(flown, "injection_velocity_m_s");
  std::printf("%.0f s ahead, predicted less flown: %.1f m, %.4f m/s, %.6f deg of inclination\n",
              flown.end_time_s - third.state.time_s, altitude_m, velocity_m_s,
              predicted.at.inclination_rad / kRadPerDeg - MetricOf(flown, "inclination_deg"));
  // Measured: 7 m, 0.07 m/s.
  EXPECT_NEAR(altitude_m, 0.0, 50.0);
  EXPECT_NEAR(velocity_m_s, 0.0, 0.3);
  EXPECT_NEAR(predicted.at.inclination_rad / kRadPerDeg, MetricOf(flown, "inclination_deg"), 0.001);
}

// Whatever a stage lacks, with two burns guided or more: no worse than open loop, and not worse with more.
// Without the long test, of the stages that are guided.
TEST(MoreBurns, AreNoWorseThanOpenLoop) {
  FlightDefinition definition = DefinitionOf(GalleryLauncher(DISPERSA_CAMPAIGNS, "vega"));
  std::vector<FlightOrder> orders;
  const bool is_long = IsLong();
  const std::size_t stages = definition.vehicle.stages.size();
  for (std::size_t stage = is_long ? 0 : stages - 3; stage < stages; ++stage)
    for (const double percent : is_long ? std::vector{-6.0, -3.0, 3.0} : std::vector{-6.0, 3.0}) {
      orders.emplace_back();
      orders.back().inputs.stages[stage].specific_impulse_factor = 1.0 + 0.01 * percent;
    }
  const std::vector<FlightResult> with_two = FlyAll(FlightModel(definition), orders);
  FlightDefinition open_loop = definition;
  open_loop.guidance.closed_loop = false;
  const std::vector<FlightResult> open = FlyAll(FlightModel(open_loop), orders);
  int compared = 0;
  for (const int burns : {3, 4}) {
    definition.guidance.burns = burns;
    const std::vector<FlightResult> flown = FlyAll(FlightModel(definition), orders);
    for (std::size_t i = 0; i < orders.size(); ++i) {
      if (open[i].outcome != Outcome::kCompleted) continue;
      SCOPED_TRACE(std::to_string(burns) + " burns, order " + std::to_string(i));
      ASSERT_EQ(flown[i].outcome, Outcome::kCompleted) << flown[i].reason;
      const double flown_km = MetricOf(flown[i], "semi_major_axis_error_km"),
                   open_km = MetricOf(open[i], "semi_major_axis_error_km");
      EXPECT_GE(flown_km, std::fmin(open_km, 0.0) - 5.0);
      EXPECT_LE(flown_km, std::fmax(open_km, 0.0) + 5.0);
      EXPECT_GE(MetricOf(flown[i], "guidance_converged"), MetricOf(with_two[i], "guidance_converged"));
      ++compared;
    }
  }
  EXPECT_GE(compared, is_long ? 12 : 6);
}

}  // namespace
}  // namespace dispersa::guidance_sequence_test
