// Gains and filters by stage and time.
#include "core/control/autopilot_step.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::control_schedule_test {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kTimes_s[] = {0.0, 3.0, 10.0, 13.7, 20.0, 50.0};

const FilterSection kOwn[] = {
    {.poles_rad_s = 60.0, .poles_damping = 0.7},
    {.zeros_rad_s = 20.0, .zeros_damping = 0.1, .poles_rad_s = 20.0, .poles_damping = 0.6, .stage = 1}};

// PID with two sections in stage 1, whose schedule has entries at 10 and 20 s, and none in stage 2.
AxisConfig Scheduled(ControlLaw law = ControlLaw::kPid) {
  AxisConfig axis = SampleAxis(law);
  axis.filters.assign(kOwn, kOwn + 2);
  FilterSection low_pass = kOwn[0], notch = kOwn[1];
  low_pass.poles_rad_s = 90.0;
  notch.zeros_rad_s = notch.poles_rad_s = 26.0;
  axis.schedule = {{1, 10.0, {20.0, 8.0}, 4.0, {low_pass, notch}},
                   {1, 20.0, {10.0, 5.0}, 0.0, {low_pass, kOwn[1]}}};
  return axis;
}

AutopilotModel Model(const AxisConfig& pitch, const AxisConfig& yaw) {
  AutopilotConfig config = SampleAutopilot();
  config.pitch = pitch;
  config.yaw = yaw;
  const StageControl control{{{0.0, 60.0}, {2.0, 3.0}}, {{0.0, 60.0}, {8.0, 8.0}}, 6.0 * kRadPerDeg};
  return BuildAutopilot(config, {control, control}, 0.05);
}

AttitudeError Error(int tick, double phase) {
  return {Vector3(0.001, 0.002 * std::cos(0.3 * tick + phase), 0.003 * std::sin(0.1 * tick)),
          Vector3(0.0, 0.01 * std::sin(0.2 * tick), -0.02 * std::cos(0.15 * tick + phase))};
}

TEST(LawAt, IsTheStagesOwnAtIgnitionStraightBetweenAndHeldAfter) {
  const AxisLaw law = BuildAxisLaw(Scheduled(), kTick_s);
  EXPECT_EQ(LawAt(law, 0, 0.0).kp_1_s2, 16.0);
  EXPECT_DOUBLE_EQ(LawAt(law, 0, 5.0).kp_1_s2, 18.0);
  EXPECT_EQ(LawAt(law, 0, 10.0).kp_1_s2, 20.0);
  EXPECT_DOUBLE_EQ(LawAt(law, 0, 15.0).kp_1_s2, 15.0);
  EXPECT_EQ(LawAt(law, 0, 20.0).kp_1_s2, 10.0);
  EXPECT_EQ(LawAt(law, 0, 99.0).kp_1_s2, 10.0);
  EXPECT_DOUBLE_EQ(LawAt(law, 0, 15.0).kd_1_s, 6.5);
  EXPECT_DOUBLE_EQ(LawAt(law, 0, 5.0).ki_1_s3, 6.0);
  EXPECT_EQ(LawAt(law, 0, 20.0).ki_1_s3, 0.0);
  const DigitalSection at_ignition = Discretise(kOwn[0], kTick_s);
  const DigitalSection later = Discretise(Scheduled().schedule[0].filters[0], kTick_s);
  EXPECT_DOUBLE_EQ(LawAt(law, 0, 5.0).filters[0].a1, 0.5 * (at_ignition.a1 + later.a1));
  EXPECT_EQ(LawAt(law, 0, 15.0).filters[0].b0, later.b0) << "the same in both entries";
  EXPECT_EQ(LawAt(law, 1, 15.0).kp_1_s2, 25.0) << "stage 2 has no schedule";
}

TEST(LawAt, KeepsSectionsStableAndOfUnitGainAtRest) {
  AxisConfig axis = Scheduled();
  // As far apart as sections go.
  axis.schedule[0].filters = {
      {.poles_rad_s = 310.0, .poles_damping = 3.0},
      {.zeros_rad_s = 3.0, .zeros_damping = 0.01, .poles_rad_s = 250.0, .poles_damping = 0.05}};
  const AxisLaw law = BuildAxisLaw(axis, kTick_s);
  for (double t = 0.0; t <= 20.0; t += 0.1) {
    const StageLaw now = LawAt(law, 0, t);
    for (const DigitalSection& f : {now.filters[0], now.filters[1]}) {
      EXPECT_LT(std::fabs(f.a2), 1.0) << t;
      EXPECT_LT(std::fabs(f.a1), 1.0 + f.a2) << t;
      EXPECT_NEAR(f.b0 + f.b1 + f.b2, 1.0 + f.a1 + f.a2, 1e-10) << t;
    }
  }
}

TEST(StepAxis, FollowsTheScheduleAsIfEveryTickHadALawOfItsOwn) {
  const AxisLaw law = BuildAxisLaw(Scheduled(), kTick_s);
  AxisState state, expected_state;
  AxisTelemetry telemetry;
  for (int tick = 0; tick < 2500; ++tick) {
    const double t = kTick_s * tick;
    AxisLaw frozen = BuildAxisLaw(SampleAxis(ControlLaw::kPid), kTick_s);
    frozen.config.filters = law.config.filters;
    frozen.stages[0] = LawAt(law, 0, t);
    const AttitudeError error = Error(tick, 0.0);
    const double u =
        StepAxis(law, 0, error.angle_rad.y(), error.rate_rad_s.y(), 1.0, 1.0, kTick_s, state, telemetry, t);
    ASSERT_EQ(u, StepAxis(frozen, 0, error.angle_rad.y(), error.rate_rad_s.y(), 1.0, 1.0, kTick_s,
                          expected_state, telemetry, t))
        << tick;
  }
}

TEST(StepGimbals, OfEqualEntriesHasTheBitsOfNone) {
  for (const ControlLaw law : {ControlLaw::kPid, ControlLaw::kPidAac, ControlLaw::kAdaptiveFuzzy}) {
    AxisConfig with = Scheduled(law), without = Scheduled(law);
    without.schedule.clear();
    for (ScheduleEntry& entry : with.schedule) {
      entry.gains = with.gains[0];
      entry.ki_1_s3 = with.integral.ki_1_s3[0];
      entry.filters = with.filters;
    }
    const AutopilotModel a = Model(with, with), b = Model(without, without);
    AutopilotState of_a, of_b;
    StartStage(a, 0, of_a);
    StartStage(b, 0, of_b);
    for (int tick = 0; tick < 2500; ++tick) {
      const GimbalCommand x =
          StepGimbals(a, 0, kTick_s * tick, Error(tick, 0.0), Vector2(1.5, 0.5), 0.9, of_a);
      const GimbalCommand y =
          StepGimbals(b, 0, kTick_s * tick, Error(tick, 0.0), Vector2(1.5, 0.5), 0.9, of_b);
      ASSERT_EQ(x.pitch_rad, y.pitch_rad) << tick;
      ASSERT_EQ(x.yaw_rad, y.yaw_rad) << tick;
    }
  }
}

// Lanes at other times and in other stages, one of them scheduled in one axis alone. A lane goes to the other
// stage and back.
template <class T>
void ExpectLanesAsAlone() {
  const AutopilotModel model = Model(Scheduled(), SampleAxis(ControlLaw::kPd));
  constexpr int kLanes = lanes::kWidth<T>;
  lanes::GimbalLoop<T> loop;
  AxisMemory<T> memory[kAxes];
  AutopilotState alone[kLanes];
  int stage_of[kLanes];
  const auto enter = [&](int lane, int stage) {
    stage_of[lane] = stage;
    lanes::SetLoop(loop, lane, model, stage, 1.0, 1.0, 1.0);
    StartStage(model, stage, alone[lane]);
    for (int axis = 0; axis < kAxes; ++axis)
      lanes::SetLaneValues<T>(memory[axis], lane, alone[lane].axes[axis]);
  };
  for (int lane = 0; lane < kLanes; ++lane) enter(lane, lane == 2 ? 1 : 0);
  for (int tick = 0; tick < 1500; ++tick) {
    if (tick == 800) enter(1, 1);
    if (tick == 1000) enter(1, 0);
    T since;
    lanes::Vector<T> angle, rate;
    for (int lane = 0; lane < kLanes; ++lane) {
      const AttitudeError error = Error(tick, lane);
      lanes::Lane(since, lane) = kTimes_s[lane % 6] + kTick_s * tick;
      lanes::SetLane(angle, lane, {error.angle_rad.x(), error.angle_rad.y(), error.angle_rad.z()});
      lanes::SetLane(rate, lane, {error.rate_rad_s.x(), error.rate_rad_s.y(), error.rate_rad_s.z()});
    }
    lanes::GimbalOutput<T> out;
    lanes::StepGimbals<true>(model, loop, since > T(-1.0), since, angle, rate, static_cast<const T*>(nullptr),
                             static_cast<const T*>(nullptr), memory, out);
    for (int lane = 0; lane < kLanes; ++lane) {
      const GimbalCommand c = StepGimbals(model, stage_of[lane], lanes::Lane(since, lane), Error(tick, lane),
                                          Vector2::Ones(), 1.0, alone[lane]);
      ASSERT_EQ(lanes::Lane(out.deflection_rad[kPitch], lane), c.pitch_rad) << tick << " lane " << lane;
      ASSERT_EQ(lanes::Lane(out.deflection_rad[kYaw], lane), c.yaw_rad) << tick << " lane " << lane;
    }
  }
}
TEST(StepGimbals, EachLaneHasTheLawOfItsOwnTime) {
  ExpectLanesAsAlone<lanes::Pack<4>>();
  ExpectLanesAsAlone<lanes::Pack<8>>();
}

TEST(LineariseLaw, IsThatOfItsInstant) {
  const AutopilotModel model = Model(Scheduled(), Scheduled());
  const LinearLaw law = LineariseLaw(model, 0, 15.0, kPitch, false);
  EXPECT_DOUBLE_EQ(law.kp_1_s2, 15.0);
  EXPECT_DOUBLE_EQ(law.kd_1_s, 6.5);
  EXPECT_DOUBLE_EQ(law.drive_error, 2.0);
  EXPECT_DOUBLE_EQ(law.effectiveness_1_s2, 2.25);
  ASSERT_EQ(law.filters.size(), 2u);
  EXPECT_EQ(law.filters[1].a1, LawAt(model.laws[kPitch], 0, 15.0).filters[1].a1);
  EXPECT_EQ(LineariseLaw(model, 1, 15.0, kPitch, false).kp_1_s2, 25.0);
}

// What a file cannot have; for the others see tests/data/messages/autopilot.txt.
TEST(Problems, NameAScheduleThatCannotBeFollowed) {
  AutopilotConfig autopilot = SampleAutopilot();
  autopilot.yaw.schedule = {{1, 0.0, {1.0, 2.0}, 0.0, {}}};
  std::vector<std::string> texts;
  for (const StructProblem& p : Problems(autopilot, 2))
    texts.push_back(p.path + ": " + p.message + ": " + p.allowed);
  EXPECT_THAT(texts,
              ElementsAre("yaw.schedule[0].at_s: is not after ignition: times since ignition that rise, "
                          "the first above 0, where the stage's own gains hold"));
}

}  // namespace
}  // namespace dispersa::control_schedule_test
