// The gates that every shipped autopilot must pass, computed and measured: gain 6 dB both ways, phase 30°,
// delay 20 ms (flight/margins.h). `dispersa margins` shows these margins.
#include "core/margins/flight_margins.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::autopilot_gates_test {
namespace {

class ShippedAutopilot : public testing::TestWithParam<const char*> {
 protected:
  FlightModel model_{Slv4Definition(DISPERSA_CAMPAIGNS, GetParam())};
};

TEST_P(ShippedAutopilot, HasTheComputedMarginsFrozenAdaptingAndLearntAtEveryInstant) {
  const std::vector<ComputedMargins> computed = ComputeMargins(model_);
  // Named instants of four stages and a sample every 5 s of 211 s, three axes each.
  ASSERT_GT(computed.size(), 100u);
  for (const ComputedMargins& m : computed) {
    EXPECT_TRUE(PassesGates(m.frozen)) << "frozen at " << m.time_s << " s, axis " << m.axis;
    EXPECT_TRUE(PassesGates(m.adapting)) << "adapting at " << m.time_s << " s, axis " << m.axis;
    EXPECT_TRUE(PassesGates(m)) << "learnt at " << m.time_s << " s, axis " << m.axis;
  }
}

TEST_P(ShippedAutopilot, HasTheMeasuredMarginsInEveryStage) {
  const std::vector<MeasuredMargins> measured = MeasureMargins(model_);
  ASSERT_EQ(measured.size(), 4u);
  for (const MeasuredMargins& m : measured)
    EXPECT_TRUE(PassesGates(m)) << "stage " << m.stage + 1 << ": " << m.gain_up_db << " dB up, "
                                << m.gain_down_db << " dB down, " << m.delay_s << " s";
}

// The paper's law as in (32), without spread, with the integral action of the shipped one. About zero error
// it passes. If the central rule alone has learnt a trim, it fails, because of the edge in the surface.
TEST(SpreadFreeLaw, PassesAboutZeroErrorAndFailsWhereItHasLearnt) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "adaptive_fuzzy");
  for (AxisConfig* axis : {&definition.autopilot.pitch, &definition.autopilot.yaw}) {
    axis->adaptation.spread_1_s = 0.0;
    for (double& gamma : axis->adaptation.gamma) gamma /= kFuzzyRules;
  }
  std::set<int> failing;
  for (const ComputedMargins& m : ComputeMargins(FlightModel(definition))) {
    EXPECT_TRUE(PassesGates(m.frozen) && PassesGates(m.adapting)) << m.time_s << " s, axis " << m.axis;
    if (!PassesGates(m)) failing.insert(m.stage);
  }
  EXPECT_EQ(failing.size(), 4u);
  for (const MeasuredMargins& m : MeasureMargins(FlightModel(definition))) EXPECT_FALSE(PassesGates(m));
}

INSTANTIATE_TEST_SUITE_P(Laws, ShippedAutopilot,
                         testing::Values("adaptive_fuzzy", "frozen_fuzzy", "pd", "pid", "lqr", "pd_aac",
                                         "pid_aac"),
                         [](const auto& law) { return std::string(law.param); });

}  // namespace
}  // namespace dispersa::autopilot_gates_test
