// The three axes together: stages, mixing, saturation, reaction control, and contradictions in a file.
#include "core/control/autopilot.h"

#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::control_autopilot_test {
namespace {

const Vector2 kNoStudy = Vector2::Ones();
constexpr double kLimit = 6.0 * kRadPerDeg;

StageControl Effectiveness(double pitch, double roll) {
  return {{{0.0, 1.0}, {pitch, pitch}}, {{0.0, 1.0}, {roll, roll}}, kLimit};
}

AutopilotModel Model(const AutopilotConfig& config = SampleAutopilot()) {
  return BuildAutopilot(config, {Effectiveness(2.0, 8.0), Effectiveness(10.0, 40.0)}, 0.05);
}

AttitudeError ErrorOf(double roll, double pitch, double yaw) {
  return {Vector3(roll, pitch, yaw), Vector3::Zero()};
}

TEST(StepGimbals, DividesEachAxisByItsEffectiveness) {
  const AutopilotModel model = Model();
  AutopilotState state;
  StartStage(model, 0, state);
  const GimbalCommand c = StepGimbals(model, 0, 0.0, ErrorOf(0.01, 0.02, 0.03), kNoStudy, 1.0, state);
  EXPECT_NEAR(c.roll_rad, 16.0 * 0.01 / 8.0, 1e-16);
  EXPECT_NEAR(c.pitch_rad, 16.0 * 0.02 / 2.0, 1e-15);
  EXPECT_NEAR(c.yaw_rad, 16.0 * 0.03 / 2.0, 1e-15);
}

TEST(StepGimbals, LoopGainMultipliesEveryCommand) {
  const AutopilotModel model = Model();
  AutopilotState a, b;
  StartStage(model, 0, a);
  StartStage(model, 0, b);
  const AttitudeError error = ErrorOf(0.001, 0.002, 0.003);
  const GimbalCommand one = StepGimbals(model, 0, 0.0, error, kNoStudy, 1.0, a);
  const GimbalCommand half = StepGimbals(model, 0, 0.0, error, kNoStudy, 0.5, b);
  EXPECT_EQ(half.roll_rad, 0.5 * one.roll_rad);
  EXPECT_EQ(half.pitch_rad, 0.5 * one.pitch_rad);
  EXPECT_EQ(half.yaw_rad, 0.5 * one.yaw_rad);
}

TEST(StepGimbals, AddsWhatTheProgramAsks) {
  const AutopilotModel model = Model();
  AutopilotState state;
  StartStage(model, 0, state);
  AttitudeError error = ErrorOf(0.0, 0.02, 0.0);
  error.program_rad_s2 = Vector3(0.08, -0.04, 0.02);
  const GimbalCommand c = StepGimbals(model, 0, 0.0, error, kNoStudy, 1.0, state);
  EXPECT_NEAR(c.roll_rad, 0.08 / 8.0, 1e-16);
  EXPECT_NEAR(c.pitch_rad, (16.0 * 0.02 - 0.04) / 2.0, 1e-15);
  EXPECT_NEAR(c.yaw_rad, 0.02 / 2.0, 1e-16);
  EXPECT_NEAR(c.telemetry[kPitch].command_rad_s2, 16.0 * 0.02 - 0.04, 1e-15);
}

TEST(StepGimbals, RemembersTheSenseOfSaturation) {
  const AutopilotModel model = Model();
  AutopilotState state;
  StartStage(model, 0, state);
  StepGimbals(model, 0, 0.0, ErrorOf(0.0, 0.05, -0.05), kNoStudy, 1.0, state);
  EXPECT_EQ(state.axes[kRoll].saturation, 0.0);
  EXPECT_EQ(state.axes[kPitch].saturation, 1.0);
  EXPECT_EQ(state.axes[kYaw].saturation, -1.0);
  StepGimbals(model, 0, 0.0, ErrorOf(0.0, 0.0, 0.0), kNoStudy, 1.0, state);
  for (const AxisState& axis : state.axes) EXPECT_EQ(axis.saturation, 0.0);
}

TEST(GimbalCommand, MixesPairsAndRoll) {
  GimbalCommand c;
  c.roll_rad = 0.001;
  c.pitch_rad = 0.02;
  c.yaw_rad = 0.03;
  EXPECT_EQ(c.Nozzles(), (std::array<double, 4>{0.02 + 0.001, 0.02 - 0.001, 0.03 + 0.001, 0.03 - 0.001}));
}

// The state that the pitch axis has learnt in stage 1 after a constant error.
AutopilotState Learnt(const AutopilotModel& model) {
  AutopilotState state;
  StartStage(model, 0, state);
  for (int i = 0; i < 100; ++i)
    StepGimbals(model, 0, 0.01 * i, ErrorOf(0.0, 0.01, 0.0), kNoStudy, 1.0, state);
  return state;
}

TEST(StartStage, CarriesWhatWasLearntOntoTheNextStagesRules) {
  const AutopilotModel model = Model();
  AutopilotState state = Learnt(model);
  const AxisState learnt = state.axes[kPitch];
  double size = 0.0;
  for (const double departure : learnt.departure_rad_s2) size += std::fabs(departure);
  ASSERT_GT(size, 0.01);
  StartStage(model, 1, state);
  for (std::size_t i = 0; i < kFuzzyRules; ++i)
    EXPECT_EQ(state.axes[kPitch].departure_rad_s2[i], learnt.departure_rad_s2[i]);
  // So at zero error the trim in rad/s² goes on without a bump.
  AutopilotState before = Learnt(model);
  const double trim =
      StepGimbals(model, 0, 1.0, ErrorOf(0, 0, 0), kNoStudy, 1.0, before).telemetry[kPitch].command_rad_s2;
  const double carried =
      StepGimbals(model, 1, 0.0, ErrorOf(0, 0, 0), kNoStudy, 1.0, state).telemetry[kPitch].command_rad_s2;
  ASSERT_GT(std::fabs(trim), 1e-4);
  EXPECT_NEAR(carried, trim, 1e-15);
}

TEST(StartStage, StartsAnewWhenConfiguredAndClearsSaturationAndThrusters) {
  AutopilotConfig config = SampleAutopilot();
  config.pitch.adaptation.reset_at_ignition = true;
  const AutopilotModel model = Model(config);
  AutopilotState state = Learnt(model);
  state.axes[kRoll].saturation = state.axes[kPitch].saturation = 1.0;
  state.axes[kYaw].saturation = -1.0;
  state.thrusters[kYaw].direction = 1;
  StartStage(model, 1, state);
  for (const double departure : state.axes[kPitch].departure_rad_s2) EXPECT_EQ(departure, 0.0);
  for (const AxisState& axis : state.axes) EXPECT_EQ(axis.saturation, 0.0);
  EXPECT_EQ(state.thrusters[kYaw].direction, 0);
}

TEST(StartStage, AugmentationStartsEveryStageAnew) {
  AutopilotConfig config = SampleAutopilot();
  config.yaw.law = ControlLaw::kPdAac;
  config.yaw.augmentation = {.adaptive_gain_1_s = 1e5,
                             .leakage_1_s = 0.1,
                             .spectral_gain_1_s = 1.0,
                             .high_pass_rad_s = 20.0,
                             .low_pass_rad_s = 2.0,
                             .minimum_total_gain = 0.5,
                             .maximum_total_gain = 2.0};
  const AutopilotModel model = Model(config);
  AutopilotState state;
  StartStage(model, 0, state);
  for (int i = 0; i < 50; ++i) StepGimbals(model, 0, 0.01 * i, ErrorOf(0.0, 0.0, 0.05), kNoStudy, 1.0, state);
  ASSERT_GT(state.axes[kYaw].total_gain, 1.1);
  ASSERT_EQ(state.axes[kYaw].model_started, 1.0);
  StartStage(model, 1, state);
  EXPECT_EQ(state.axes[kYaw].total_gain, 1.0);
  EXPECT_EQ(state.axes[kYaw].model_started, 0.0);
}

TEST(BuildStageControl, IsThrustTimesLeverOverInertia) {
  const LauncherPlant plant = BuildNominalPlant(SampleVehicle());
  const StageControl control = BuildStageControl(plant, 1);
  for (const double since : {0.0, 20.0}) {
    const MassProperties m = plant.stacks[1].mass.At(1000.0 * (1.0 - since / 20.0));
    // Two of four nozzles in pitch, all four on a radius of 0.3 m in roll; table nodes fall on both times.
    EXPECT_NEAR(control.pitch_effectiveness_1_s2(since),
                25e3 * (10.0 - m.cg_station_m) / m.transverse_inertia_kg_m2, 1e-12);
    EXPECT_NEAR(control.roll_effectiveness_1_s2(since), 50e3 * 0.3 / m.axial_inertia_kg_m2, 1e-10);
  }
  // Between the nodes the table's own claim: a part in a thousand.
  const MassProperties m = plant.stacks[1].mass.At(1000.0 * (1.0 - 0.3 / 20.0));
  const double exact = 25e3 * (10.0 - m.cg_station_m) / m.transverse_inertia_kg_m2;
  EXPECT_NEAR(control.pitch_effectiveness_1_s2(0.3), exact, 1e-3 * exact);
  EXPECT_EQ(control.limit_rad, kLimit);
}

// A curve whose corners lie between the even nodes: a rise of 12 ms, a step within 3 ms and a tail-off
// through the least level. Both tables have them, and the rows that flights look up are the tables.
TEST(BuildStageControl, HasTheCornersOfAThrustCurve) {
  Vehicle vehicle = SampleVehicle();
  Motor& motor = vehicle.stages[0].motor;
  motor.thrust_curve = {{0.0, 0.012, 17.3331, 17.3361, 39.0, 41.23}, {0.0, 150e3, 200e3, 120e3, 110e3, 0.0}};
  motor.thrust_n = motor.thrust_curve.Greatest();
  motor.burning_time_s = motor.thrust_curve.Impulse() / motor.thrust_n;
  const LauncherPlant plant = BuildNominalPlant(vehicle);
  const LauncherStack& stack = plant.stacks[0];
  const StageControl control = BuildStageControl(plant, 0);
  const AutopilotModel model = BuildAutopilot(SampleAutopilot(), {control, Effectiveness(1.0, 1.0)}, 0.05);
  for (int i = 0; i <= 41230; ++i) {
    const double since = 1e-3 * i;
    const double thrust =
        stack.burn.vacuum_thrust_n * std::max(stack.burn.Fraction(since), kLeastThrustFraction);
    const MassProperties m = stack.mass.At(stack.burn.Propellant(since));
    const double pitch = 0.5 * thrust * (19.5 - m.cg_station_m) / m.transverse_inertia_kg_m2;
    ASSERT_NEAR(control.pitch_effectiveness_1_s2(since), pitch, 1e-3 * pitch) << since;
    const double* row = model.effectiveness[0].Row(model.effectiveness[0].IndexAt(since));
    ASSERT_NEAR(row[0] + row[1] * since, control.pitch_effectiveness_1_s2(since), 1e-9) << since;
    ASSERT_NEAR(row[2] + row[3] * since, control.roll_effectiveness_1_s2(since), 1e-8) << since;
  }
}

// Reaction control: deadband 1, switching line e + 0.5 de/dt, closes half-way back.
constexpr ReactionControlLogic kLogic = {.deadband_rad = 1.0, .rate_gain_s = 0.5, .hysteresis = 0.5};

TEST(StepThrusters, OpensBeyondTheDeadbandAgainstTheError) {
  ThrusterState state;
  EXPECT_EQ(StepThrusters(kLogic, 1.0, 0.0, 1, state), 0);
  EXPECT_EQ(StepThrusters(kLogic, 1.01, 0.0, 1, state), 1);
  ThrusterState other;
  EXPECT_EQ(StepThrusters(kLogic, -1.01, 0.0, 1, other), -1);
}

TEST(StepThrusters, RateCountsByItsGain) {
  ThrusterState state;
  EXPECT_EQ(StepThrusters(kLogic, 0.0, 2.0, 1, state), 0);
  EXPECT_EQ(StepThrusters(kLogic, 0.0, 2.1, 1, state), 1);
}

TEST(StepThrusters, ClosesAcrossTheHysteresisOnly) {
  ThrusterState state;
  StepThrusters(kLogic, 1.2, 0.0, 1, state);
  EXPECT_EQ(StepThrusters(kLogic, 0.9, 0.0, 1, state), 1);
  EXPECT_EQ(StepThrusters(kLogic, 0.51, 0.0, 1, state), 1);
  EXPECT_EQ(StepThrusters(kLogic, 0.5, 0.0, 1, state), 0);
  EXPECT_EQ(StepThrusters(kLogic, 0.9, 0.0, 1, state), 0);
}

TEST(StepThrusters, StaysOpenForItsMinimumTime) {
  ThrusterState state;
  EXPECT_EQ(StepThrusters(kLogic, 1.2, 0.0, 3, state), 1);
  EXPECT_EQ(StepThrusters(kLogic, 0.0, 0.0, 3, state), 1);
  EXPECT_EQ(StepThrusters(kLogic, 0.0, 0.0, 3, state), 1);
  EXPECT_EQ(StepThrusters(kLogic, 0.0, 0.0, 3, state), 0);
}

TEST(StepThrusters, ReversesAtOnceWhenTheOtherSideIsLeft) {
  ThrusterState state;
  StepThrusters(kLogic, 1.2, 0.0, 1, state);
  EXPECT_EQ(StepThrusters(kLogic, -1.2, 0.0, 1, state), -1);
}

TEST(StepReactionControl, EveryAxisHasItsOwnMemory) {
  const AutopilotModel model = Model();
  AutopilotState state;
  const double deadband = 0.1 * kRadPerDeg;
  const auto fired = StepReactionControl(model, ErrorOf(1.5 * deadband, 0.0, -1.5 * deadband), state);
  EXPECT_EQ(fired, (std::array<int, kAxes>{1, 0, -1}));
}

TEST(BuildAutopilot, MinimumOnTimeIsWholeCyclesRoundedUp) {
  AutopilotConfig config = SampleAutopilot();
  EXPECT_EQ(BuildAutopilot(config, {}, 0.05).thruster_minimum_cycles, 5);
  EXPECT_EQ(BuildAutopilot(config, {}, 0.051).thruster_minimum_cycles, 6);
  config.reaction_control.cycle_ticks = 5;
  EXPECT_EQ(BuildAutopilot(config, {}, 0.05).thruster_minimum_cycles, 1);
}

// Problems ---------------------------------------------------------------------------------------------

std::vector<std::string> Texts(const AutopilotConfig& config, int stages = 2) {
  std::vector<std::string> texts;
  for (const StructProblem& p : Problems(config, stages))
    texts.push_back(p.path + ": " + p.message + " | " + p.allowed);
  return texts;
}

AutopilotConfig With(const std::function<void(AutopilotConfig&)>& change) {
  AutopilotConfig config = SampleAutopilot();
  change(config);
  return config;
}

using List = std::vector<std::string>;

TEST(AutopilotProblems, NoneInTheSample) { EXPECT_EQ(Texts(SampleAutopilot()), List{}); }

AutopilotConfig WithPn(double error, double rate) {
  return With([&](AutopilotConfig& c) {
    c.pitch.gains[1] = c.pitch.gains[0];
    c.pitch.adaptation.p_n = Vector2(error, rate);
  });
}

TEST(AutopilotProblems, APluginIsTheLawOfAnAxisAndTheLawOfAnAxisIsThere) {
  EXPECT_EQ(Texts(With([](auto& c) { c.plugin.emplace(); })),
            (List{"plugin: is the law of no axis | law: plugin of pitch, yaw or roll, or no plugin"}));
  EXPECT_EQ(Texts(With([](auto& c) { c.roll.law = ControlLaw::kPlugin; })),
            (List{"roll.law: is a plug-in's, and the autopilot names none | plugin: {library: FILE}"}));
  EXPECT_EQ(Texts(With([](auto& c) {
              c.plugin.emplace();
              c.roll.law = ControlLaw::kPlugin;
            })),
            List{});
}

TEST(AutopilotProblems, AnUnprovenPnMayBeStudied) {
  AutopilotConfig config = WithPn(-1.0, 5.0);
  config.pitch.adaptation.allow_unproven = true;
  EXPECT_EQ(Texts(config), List{});
  const AxisLaw law = BuildAxisLaw(config.pitch, config.tick_s);
  EXPECT_EQ(law.stages[0].pn_error, -1.0);
  EXPECT_EQ(law.stages[0].pn_rate, 5.0);
}

}  // namespace
}  // namespace dispersa::control_autopilot_test
