// Tail-offs of engines that are cut off: the orbit is that of a burn that ends at once, and a decay of
// another duration than the flight computer knows changes the speed by its impulse.
#include "core/campaign/flight_definition.h"
#include "core/flight/history.h"
#include "core/math/constants.h"
#include "tests/gallery_launcher.h"
#include "tests/liquid_stage.h"
#include "tests/long.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::tail_off_test {
namespace {

constexpr double kTail_s = 0.8;

Campaign Launcher(const std::string& name, double tail_off_s, bool closed_loop) {
  Campaign campaign = GalleryLauncher(DISPERSA_CAMPAIGNS, name);
  campaign.guidance.closed_loop = closed_loop;
  for (Stage& stage : campaign.vehicle.stages)
    if (stage.is_liquid()) stage.motor.tail_off_s = tail_off_s;
  return campaign;
}

Stage LiquidStage() {
  Stage stage = Slv4Definition(DISPERSA_CAMPAIGNS).vehicle.stages[0];
  MakeLiquid(stage);
  stage.motor.cut_off = CutOff::kAtTime;
  stage.motor.cut_off_s = 50.0;
  return stage;
}

TEST(TailOff, BurnsWhatABurnWouldThatEndsAtOnce) {
  Stage stage = LiquidStage();
  const MotorBurn sharp = BuildBurn(stage, 1.0, 1.0);
  stage.motor.tail_off_s = kTail_s;
  MotorBurn decays = BuildBurn(stage, 1.0, 1.0);
  EXPECT_NEAR(decays.duration_s, 50.0 + 0.5 * kTail_s, 1e-12);
  EXPECT_NEAR(decays.left_kg, sharp.left_kg, 1e-9 * sharp.left_kg);
  EXPECT_NEAR(decays.Fraction(50.0 - 0.5 * kTail_s), 1.0, 1e-12);
  EXPECT_NEAR(decays.Fraction(50.0), 0.5, 1e-12);
  EXPECT_NEAR(decays.Fraction(50.0 + 0.4 * kTail_s), 0.1, 1e-9);
  // A decay of another duration begins at the same command.
  SetTailOff(1.5, stage, decays);
  EXPECT_NEAR(decays.duration_s, 50.0 + kTail_s, 1e-12);
  EXPECT_NEAR(decays.Fraction(50.0 - 0.5 * kTail_s), 1.0, 1e-12);
  EXPECT_NEAR(sharp.left_kg - decays.left_kg, 0.25 * kTail_s * decays.full_flow_kg_s, 1e-6);
}

TEST(TailOff, EndsWithThePropellant) {
  Stage stage = LiquidStage();
  stage.motor.tail_off_s = 1.0;
  stage.motor.cut_off_s = stage.motor.burning_time_s + 0.3;  // commanded 0.2 s before the tanks are empty
  const MotorBurn burn = BuildBurn(stage, 1.0, 1.0);
  // 0.2 s at full flow are left: t - t²/2 = 0.2.
  EXPECT_NEAR(burn.duration_s, stage.motor.burning_time_s - 0.2 + (1.0 - std::sqrt(0.6)), 1e-9);
  EXPECT_NEAR(burn.left_kg, 0.0, 1e-6);
  stage.motor.cut_off_s = stage.motor.burning_time_s + 0.6;  // too late
  EXPECT_EQ(BuildBurn(stage, 1.0, 1.0).duration_s, stage.motor.burning_time_s);
}

// Of a solid motor it takes longer, and its impulse stays.
TEST(TailOff, OfASolidMotorKeepsItsPropellant) {
  Stage stage = Slv4Definition(DISPERSA_CAMPAIGNS).vehicle.stages[0];
  stage.motor.tail_off_s = 2.0;
  MotorBurn burn = BuildBurn(stage, 1.0, 1.0);
  const double duration_s = burn.duration_s;
  SetTailOff(1.5, stage, burn);
  EXPECT_NEAR(burn.duration_s, duration_s + 0.5, 1e-12);
  EXPECT_NEAR(burn.Propellant(burn.duration_s), 0.0, 1e-9 * stage.propellant_mass_kg);
  EXPECT_NEAR(burn.Fraction(burn.duration_s - 1.5), 0.5, 1e-9);
}

// The last stage's thrust over its mass as the burn ends, m/s².
double AccelerationAtTheEnd(const History& history) {
  const int stage = FindHistoryColumn("stage"), thrust = FindHistoryColumn("thrust_n"),
            mass = FindHistoryColumn("mass_kg");
  double at_the_end = 0.0;
  for (std::size_t row = 0; row < history.rows(); ++row)
    if (history.at(row, thrust) > 0.0 && history.at(row, stage) == history.at(history.rows() - 1, stage))
      at_the_end = std::max(at_the_end, history.at(row, thrust) / history.at(row, mass));
  return at_the_end;
}

class Launchers : public testing::TestWithParam<const char*> {};

TEST_P(Launchers, ReachTheOrbitOfABurnThatEndsAtOnce) {
  for (const bool closed : {false, true}) {
    SCOPED_TRACE(closed ? "closed loop" : "open loop");
    const FlightModel sharp(DefinitionOf(Launcher(GetParam(), 0.0, closed))),
        decays(DefinitionOf(Launcher(GetParam(), kTail_s, closed)));
    History history;
    history.step_s = 0.1;
    FlightOptions recording;
    recording.history = &history;
    const FlightResult at_once = Fly(sharp, {}, recording), nominal = Fly(decays, {});
    ASSERT_EQ(nominal.outcome, Outcome::kCompleted) << nominal.reason;
    const double axis_km = MetricOf(nominal, "semi_major_axis_error_km") -
                           MetricOf(at_once, "semi_major_axis_error_km"),
                 speed_m_s = MetricOf(nominal, "injection_velocity_error_m_s") -
                             MetricOf(at_once, "injection_velocity_error_m_s");
    // A drawn decay adds half of what it lasts longer at full thrust.
    FlightInputs longer;
    for (StageInputs& stage : longer.stages) stage.tail_off_factor = 1.0;
    longer.stages[decays.nominal_plant().stacks.size() - 1].tail_off_factor = 1.2;
    const FlightResult drawn = Fly(decays, longer);
    const double gained_m_s =
                     MetricOf(drawn, "injection_velocity_m_s") - MetricOf(nominal, "injection_velocity_m_s"),
                 expected_m_s = 0.5 * 0.2 * kTail_s * AccelerationAtTheEnd(history);
    std::printf("%s %s: axis %.4f km and %.4f m/s by the decay; 20 %% longer: %.4f m/s, expected %.4f\n",
                GetParam(), closed ? "closed" : "open", axis_km, speed_m_s, gained_m_s, expected_m_s);
    EXPECT_LT(std::fabs(axis_km), 0.1);
    EXPECT_NEAR(drawn.end_time_s - nominal.end_time_s, 0.2 * kTail_s, 1e-6);
    EXPECT_NEAR(gained_m_s, expected_m_s, 0.03 * expected_m_s + 0.01);
    if (closed) {
      EXPECT_EQ(MetricOf(nominal, "guidance_converged"), 1.0);
    }
  }
}

// Electron: a velocity ends the last burn, which is the only one of its stage. Vega and Falcon 9: a restart,
// ended by a timer and by the energy.
INSTANTIATE_TEST_SUITE_P(Gallery, Launchers,
                         testing::ValuesIn(IsLong() ? std::vector{"electron", "vega", "falcon9"}
                                                    : std::vector{"electron", "falcon9"}));

// A longer decay of the first burn takes propellant from the second.
TEST(TailOff, TakesFromTheRestart) {
  const FlightModel model(DefinitionOf(Launcher("falcon9", kTail_s, false)));
  const std::size_t first = model.nominal_plant().stacks.size() - 2;
  FlightInputs longer;
  longer.stages[first].tail_off_factor = 1.5;
  const auto left_kg = [&](const FlightInputs& inputs) {
    History history;
    history.step_s = 0.1;
    FlightOptions options;
    options.history = &history;
    Fly(model, inputs, options);
    const int stage = FindHistoryColumn("stage"), mass = FindHistoryColumn("mass_kg");
    double least_kg = 1e12;
    for (std::size_t row = 0; row < history.rows(); ++row)
      if (history.at(row, stage) == static_cast<double>(first + 1))
        least_kg = std::min(least_kg, history.at(row, mass));
    return least_kg;
  };
  const MotorBurn& burn = model.nominal_plant().stacks[first].burn;
  const double level = model.definition().vehicle.stages[first].motor.throttle.level.back();
  EXPECT_NEAR(left_kg({}) - left_kg(longer), 0.25 * kTail_s * level * burn.full_flow_kg_s, 0.1);
}

}  // namespace
}  // namespace dispersa::tail_off_test
