// Engines with a timer, cut_off: {at: time}: guidance computes the duration of the last two burns.
#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/tick_sample.h"
#include "tests/gallery_launcher.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::guidance_timer_test {
namespace {

// A launcher of the gallery whose last two burns have timers, at the durations of its reference.
FlightDefinition WithTimers(const Campaign& campaign) {
  FlightDefinition definition = DefinitionOf(campaign);
  const std::size_t burns = definition.vehicle.stages.size();
  for (std::size_t i = burns - 2; i < burns; ++i) {
    Motor& engine = definition.vehicle.stages[i].motor;
    engine.cut_off = CutOff::kAtTime;
    engine.cut_off_s = definition.cut_off_s[i];
  }
  return definition;
}

class GuidedTimers : public testing::TestWithParam<const char*> {
 protected:
  GuidedTimers()
      : campaign_(GalleryLauncher(DISPERSA_CAMPAIGNS, GetParam())),
        flights_(campaign_),
        definition_(WithTimers(campaign_)) {}
  FlightInputs Drawn(std::uint64_t index) const { return DrawnWithoutErrorsOfTheComputer(flights_, index); }
  const Campaign campaign_;
  const CampaignFlights flights_;
  FlightDefinition definition_;
};

TEST_P(GuidedTimers, ArriveWhereFixedDurationsMissByKilometres) {
  const FlightModel closed(definition_);
  definition_.guidance.closed_loop = false;
  const FlightModel open(definition_);
  double farthest_km = 0.0;
  for (const std::uint64_t index :
       IsLong() ? std::vector<std::uint64_t>{0, 1, 2, 3} : std::vector<std::uint64_t>{0, 2}) {
    SCOPED_TRACE(index);
    const FlightInputs inputs = Drawn(index);
    const FlightResult fixed = Fly(open, inputs), solved = Fly(closed, inputs);
    ASSERT_EQ(solved.outcome, Outcome::kCompleted) << solved.reason;
    // Of the velocity: the axis of a transfer orbit says too much of it.
    const double energy_m_s = MetricOf(solved, "injection_velocity_error_m_s");
    std::printf(
        "%s %d: perigee %9.3f km, apogee %10.3f km fixed; %9.4f, %10.4f solved; converged %g, %g m/s\n",
        GetParam(), static_cast<int>(index), MetricOf(fixed, "perigee_km"), MetricOf(fixed, "apogee_km"),
        MetricOf(solved, "perigee_km"), MetricOf(solved, "apogee_km"), MetricOf(solved, "guidance_converged"),
        energy_m_s);
    EXPECT_EQ(MetricOf(solved, "guidance_converged"), 1.0);
    EXPECT_LT(std::fabs(MetricOf(solved, "inclination_error_deg")), 0.005);
    const double wrong_km = std::fabs(MetricOf(fixed, "semi_major_axis_error_km"));
    EXPECT_LT(std::fabs(MetricOf(solved, "semi_major_axis_error_km")), 0.02 * std::fmax(wrong_km, 50.0));
    farthest_km = std::fmax(farthest_km, wrong_km);
  }
  EXPECT_GT(farthest_km, 20.0);
}

// Half a per cent of specific impulse, which only the burn shows, is in the orbit if the duration is computed
// before the ignition, and is not if it is computed in the burn.
TEST_P(GuidedTimers, KnowInTheBurnWhatTheyDidNotKnowBefore) {
  FlightInputs inputs;
  inputs.stages[campaign_.vehicle.stages.size() - 1].specific_impulse_factor = 0.995;
  const double steered_km =
      std::fabs(MetricOf(Fly(FlightModel(definition_), inputs), "semi_major_axis_error_km"));
  definition_.guidance.steers_last_burn = false;
  const double planned_km =
      std::fabs(MetricOf(Fly(FlightModel(definition_), inputs), "semi_major_axis_error_km"));
  std::printf("%s: axis off by %.3f km solved in the burn, %.3f km before it\n", GetParam(), steered_km,
              planned_km);
  EXPECT_LT(steered_km, 0.1 * planned_km);
}

// Navigation whose speed overflows gives no plan: the file's duration ends the burn.
TEST_P(GuidedTimers, EndABurnByTheFilesDurationWithoutAPlan) {
  const FlightModel model(definition_);
  FlightInputs inputs;
  inputs.sensors.navigation_velocity_error_m_s[0] = 1e200;
  const int burn = static_cast<int>(campaign_.vehicle.stages.size()) - 2;
  double since_s = 0.0;
  FlightOptions options;
  options.observe = [&](const TickSample& sample) {
    if (sample.stack == burn && sample.burning) since_s = sample.since_ignition_s;
  };
  Fly(model, inputs, options);
  const Motor& engine = definition_.vehicle.stages[static_cast<std::size_t>(burn)].motor;
  EXPECT_NEAR(since_s, engine.cut_off_s + 0.5 * engine.tail_off_s, definition_.autopilot.tick_s);
}

INSTANTIATE_TEST_SUITE_P(Gallery, GuidedTimers, testing::Values("vega", "falcon9"),
                         [](const auto& launcher) { return std::string(launcher.param); });

}  // namespace
}  // namespace dispersa::guidance_timer_test
