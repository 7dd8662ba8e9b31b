// One axis of the autopilot, tick by tick: the law, its guards, and the effects that each must not have.
#include "core/control/axis_controller.h"

#include "core/control/axis_step.h"
#include "core/control/lyapunov.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::control_axis_test {
namespace {

constexpr double kTick_s = 0.01;
const Vector2 kNoStudy = Vector2::Ones();

// One axis with its memory.
struct Loop {
  explicit Loop(const AxisConfig& config) : law(BuildAxisLaw(config, kTick_s)) {}
  double Step(double error, double rate, double saturation = 0.0, const Vector2& pn_factor = kNoStudy) {
    state.saturation = saturation;
    return StepAxis(law, 0, error, rate, pn_factor.x(), pn_factor.y(), kTick_s, state, telemetry);
  }
  double FromStart(std::size_t rule) const { return state.departure_rad_s2[rule]; }
  bool HasLearnt() const {
    return std::any_of(std::begin(state.departure_rad_s2), std::end(state.departure_rad_s2),
                       [](double departure) { return departure != 0.0; });
  }
  AxisLaw law;
  AxisState state;
  AxisTelemetry telemetry;
};

AxisConfig Adaptive(const std::function<void(Adaptation&)>& change = [](Adaptation&) {}) {
  AxisConfig config = SampleAxis(ControlLaw::kAdaptiveFuzzy);
  change(config.adaptation);
  return config;
}

// Inside the rule base, where every rule of a 2 x 2 block fires.
constexpr double kError = 1.0 * kRadPerDeg;
constexpr double kRate = 0.3 * kRadPerDeg;

TEST(StepAxis, AdaptsByTheLawOfEquation32) {
  Loop loop(Adaptive());
  const double u = loop.Step(kError, kRate);
  // The command uses the consequents before the step.
  EXPECT_NEAR(u, 16.0 * kError + 7.0 * kRate, 1e-15);
  Matrix2 q;
  q << 1.0, 0.0, 0.0, 0.02;
  const Vector2 p_n = SolveLyapunov({16.0, 7.0}, q).col(1);
  const double drive = p_n.x() * kError + p_n.y() * kRate;
  const FuzzyRules& rules = loop.law.config.rules;
  double by_error[kFuzzySets], by_rate[kFuzzySets];
  lanes::Grades(2.0 + 2.0 * kError / rules.error_range_rad, by_error);
  lanes::Grades(2.0 + 2.0 * kRate / rules.rate_range_rad_s, by_rate);
  for (std::size_t i = 0; i < kFuzzyRules; ++i)
    // Rounding of grades of order 1 times the step's 0.1.
    EXPECT_NEAR(loop.FromStart(i),
                kTick_s * 500.0 * drive * by_error[i / kFuzzySets] * by_rate[i % kFuzzySets], 1e-16);
}

TEST(StepAxis, AdaptationRaisesTheCommandAgainstAStandingError) {
  Loop loop(Adaptive());
  const double first = loop.Step(kError, 0.0);
  double last = first;
  for (int i = 0; i < 100; ++i) last = loop.Step(kError, 0.0);
  EXPECT_GT(last, 1.5 * first);
}

TEST(StepAxis, GammaZeroIsTheFrozenLawBitForBit) {
  AxisConfig zero = Adaptive([](Adaptation& a) {
    a.gamma = {0.0, 0.0};
    a.leakage_1_s = 0.02;
    a.projection_bound_rad_s2 = 1.0;
  });
  AxisConfig frozen = zero;
  frozen.law = ControlLaw::kFrozenFuzzy;
  Loop a(zero), b(frozen);
  Stream draws(3, 0, "errors");
  for (int i = 0; i < 5000; ++i) {
    const double error = 0.3 * (draws.Uniform() - 0.5), rate = 0.1 * (draws.Uniform() - 0.5);
    const double ua = a.Step(error, rate), ub = b.Step(error, rate);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(ua), std::bit_cast<std::uint64_t>(ub)) << "tick " << i;
  }
  EXPECT_FALSE(a.HasLearnt());
  EXPECT_FALSE(b.HasLearnt());
}

TEST(StepAxis, ProjectionHoldsEveryConsequentWithinItsBoundAtEveryTick) {
  const double bound = 0.05;
  Loop loop(Adaptive([&](Adaptation& a) { a.projection_bound_rad_s2 = bound; }));
  Stream draws(4, 0, "errors");
  bool projected = false;
  for (int i = 0; i < 2000; ++i) {
    loop.Step(0.15 * (draws.Uniform() - 0.3), 0.05 * (draws.Uniform() - 0.3));
    projected |= loop.telemetry.projected;
    for (std::size_t rule = 0; rule < kFuzzyRules; ++rule)
      ASSERT_LE(std::fabs(loop.FromStart(rule)), bound) << "tick " << i;
  }
  EXPECT_TRUE(projected);
}

TEST(StepAxis, LeakageDrawsTheConsequentsToTheirStart) {
  Loop loop(Adaptive([](Adaptation& a) { a.leakage_1_s = 0.5; }));
  for (int i = 0; i < 50; ++i) loop.Step(kError, kRate);
  const std::size_t rule = 2 * kFuzzySets + 2;
  const double learnt = loop.FromStart(rule);
  ASSERT_GT(std::fabs(learnt), 1e-3);
  // No error drives nothing, so what is left is the leak's geometric decay.
  for (int i = 0; i < 200; ++i) loop.Step(0.0, 0.0);
  EXPECT_NEAR(loop.FromStart(rule), learnt * std::pow(1.0 - kTick_s * 0.5, 200), 1e-13);
}

TEST(StepAxis, DoesNotAdaptIntoASaturatedActuatorButOutOfIt) {
  Loop loop(Adaptive([](Adaptation& a) { a.freeze_when_saturated = true; }));
  loop.Step(kError, kRate, +1);
  EXPECT_TRUE(loop.telemetry.frozen);
  EXPECT_FALSE(loop.HasLearnt());
  loop.Step(kError, kRate, -1);
  EXPECT_FALSE(loop.telemetry.frozen);
  EXPECT_TRUE(loop.HasLearnt());
}

TEST(StepAxis, AdaptsIntoSaturationOnlyWithoutThatGuard) {
  Loop loop(Adaptive());
  loop.Step(kError, kRate, +1);
  EXPECT_FALSE(loop.telemetry.frozen);
  EXPECT_TRUE(loop.HasLearnt());
}

TEST(StepAxis, DeadZoneIsMeasuredInErrorAtZeroRate) {
  const double zone = 0.5 * kRadPerDeg;
  for (const double sign : {-1.0, 1.0}) {
    Loop loop(Adaptive([&](Adaptation& a) { a.dead_zone_rad = zone; }));
    loop.Step(sign * zone * 0.999, 0.0);
    EXPECT_TRUE(loop.telemetry.frozen);
    EXPECT_FALSE(loop.HasLearnt());
    loop.Step(sign * zone * 1.001, 0.0);
    EXPECT_FALSE(loop.telemetry.frozen);
    EXPECT_TRUE(loop.HasLearnt());
  }
}

TEST(StepAxis, SupervisoryTermRestoresTheLinearLawBeyondTheRulesOnlyAboveItsBound) {
  const auto frozen = [](double bound) {
    AxisConfig config = Adaptive([&](Adaptation& a) { a.supervisory_bound = bound; });
    config.law = ControlLaw::kFrozenFuzzy;
    return Loop(config);
  };
  const double error = 12.0 * kRadPerDeg, rate = 4.0 * kRadPerDeg;
  const double edge = 16.0 * 5.0 * kRadPerDeg + 7.0 * 1.5 * kRadPerDeg;
  Loop off = frozen(0.0), below = frozen(1e6), above = frozen(1e-6);
  EXPECT_NEAR(off.Step(error, rate), edge, 1e-14);
  EXPECT_NEAR(below.Step(error, rate), edge, 1e-14);
  EXPECT_NEAR(above.Step(error, rate), 16.0 * error + 7.0 * rate, 1e-14);
}

TEST(StepAxis, ReportsTheLyapunovFunctionAndTheSignOfItsChange) {
  Loop loop(Adaptive());
  Matrix2 q;
  q << 1.0, 0.0, 0.0, 0.02;
  const Matrix2 p = SolveLyapunov({16.0, 7.0}, q);
  const Vector2 e(kError, kRate);
  loop.Step(kError, kRate);
  EXPECT_NEAR(loop.telemetry.v, 0.5 * e.dot(p * e), 1e-18);
  EXPECT_EQ(loop.telemetry.v_rate_sign, 1.0);
  loop.Step(kError, kRate);
  EXPECT_EQ(loop.telemetry.v_rate_sign, 0.0);
  loop.Step(0.5 * kError, 0.5 * kRate);
  EXPECT_EQ(loop.telemetry.v_rate_sign, -1.0);
}

TEST(StepAxis, RemembersWhichRulesFired) {
  Loop loop(Adaptive());
  loop.Step(0.0, 0.0);
  EXPECT_EQ(loop.state.rules_fired, 1u << 12);
  loop.Step(1.0, 1.0);
  EXPECT_EQ(loop.state.rules_fired, (1u << 12) | (1u << 24));
  ResetAxis(loop.state);
  EXPECT_EQ(loop.state.rules_fired, (1u << 12) | (1u << 24)) << "coverage is of the whole flight";
}

TEST(StepAxis, AdaptationNormIsTheDistanceFromTheStart) {
  Loop loop(Adaptive());
  for (int i = 0; i < 10; ++i) loop.Step(kError, kRate);
  double squares = 0.0;
  for (std::size_t i = 0; i < kFuzzyRules; ++i) squares += loop.FromStart(i) * loop.FromStart(i);
  EXPECT_DOUBLE_EQ(loop.telemetry.adaptation_norm, std::sqrt(squares));
  EXPECT_GT(squares, 0.0);
}

TEST(StepAxis, PnFactorsScaleTheDrive) {
  Loop one(Adaptive()), twice(Adaptive()), rate_only(Adaptive());
  one.Step(kError, 0.0);
  twice.Step(kError, 0.0, 0, Vector2(2.0, 1.0));
  rate_only.Step(kError, 0.0, 0, Vector2(0.0, 1.0));
  const std::size_t rule = 2 * kFuzzySets + 2;
  EXPECT_NEAR(twice.FromStart(rule), 2.0 * one.FromStart(rule), 1e-15);
  EXPECT_EQ(rate_only.FromStart(rule), 0.0);
}

TEST(StepAxis, PdIsTheLinearLaw) {
  Loop loop(SampleAxis(ControlLaw::kPd));
  EXPECT_EQ(loop.Step(0.3, -0.2), std::fma(16.0, 0.3, 7.0 * -0.2));
}

TEST(StepAxis, PidAddsTheIntegralUpToTheTickBefore) {
  Loop loop(SampleAxis(ControlLaw::kPid));
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(loop.Step(0.3, -0.2), 16.0 * 0.3 - 7.0 * 0.2 + 8.0 * 0.3 * 0.01 * i, 1e-12);
  EXPECT_NEAR(loop.state.integral_rad_s2, 8.0 * 0.3, 1e-12);
}

TEST(StepAxis, PidWithoutIntegralGainIsPdBitForBit) {
  AxisConfig config = SampleAxis(ControlLaw::kPid);
  config.integral.ki_1_s3 = {0.0, 0.0};
  Loop pid(config), pd(SampleAxis(ControlLaw::kPd));
  Stream draws(5, 0, "errors");
  for (int i = 0; i < 500; ++i) {
    const double error = draws.Normal(), rate = draws.Normal();
    ASSERT_EQ(pid.Step(error, rate), pd.Step(error, rate));
  }
}

TEST(StepAxis, PidHoldsItsIntegralWhileTheDeflectionIsLimitedInItsSenseAndWithinItsBound) {
  AxisConfig config = SampleAxis(ControlLaw::kPid);
  Loop loop(config);
  loop.Step(0.3, 0.0, 1.0);
  EXPECT_EQ(loop.state.integral_rad_s2, 0.0);
  loop.Step(-0.3, 0.0, 1.0);
  EXPECT_NEAR(loop.state.integral_rad_s2, -8.0 * 0.3 * 0.01, 1e-15) << "out of the limit it integrates";

  config.integral.bound_rad_s2 = 0.1;
  Loop bounded(config);
  for (int i = 0; i < 100; ++i) bounded.Step(0.3, 0.0);
  EXPECT_EQ(bounded.state.integral_rad_s2, 0.1);
  for (int i = 0; i < 100; ++i) bounded.Step(-0.3, 0.0);
  EXPECT_EQ(bounded.state.integral_rad_s2, -0.1);
}

TEST(StepAxis, WhatTheRulesLearnInCommonIsAPid) {
  AxisConfig fuzzy = SampleAxis(ControlLaw::kAdaptiveFuzzy);
  fuzzy.adaptation.spread_1_s = 1.0 / kTick_s;  // every departure is the mean of the tick before
  const StageLaw law = BuildAxisLaw(fuzzy, kTick_s).stages[0];
  AxisConfig config = SampleAxis(ControlLaw::kPid);
  config.gains[0].kp_1_s2 += law.gamma * law.pn_rate / kFuzzyRules;
  config.integral.ki_1_s3[0] = law.gamma * law.pn_error / kFuzzyRules;
  Loop rules(fuzzy), pid(config);
  // Within the outer sets, where the rules start from the plane.
  const double amplitude = 0.4 * kRadPerDeg, w = 2.0;
  double largest = 0.0, apart = 0.0, learnt = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double t = i * kTick_s;
    const double error = amplitude * (1.0 - std::cos(w * t)), rate = amplitude * w * std::sin(w * t);
    const double u = rules.Step(error, rate);
    largest = std::max(largest, std::fabs(u));
    learnt = std::max(learnt, std::fabs(u - 16.0 * error - 7.0 * rate));
    apart = std::max(apart, std::fabs(u - pid.Step(error, rate)));
  }
  EXPECT_GT(learnt, 0.1 * largest);
  EXPECT_LT(apart, 0.02 * learnt);
}

TEST(StepAxis, TheNormalizedRegressorIsThatOverItsSquaredNorm) {
  const auto first_step = [](bool normalized, double error, double rate) {
    Loop loop(Adaptive([&](Adaptation& a) { a.normalized = normalized; }));
    loop.Step(error, rate);
    return loop.FromStart(2 * kFuzzySets + 2);
  };
  // At the centre of a set one rule fires wholly: nothing to normalise.
  const double wholly = first_step(false, 1e-9, 0.0);
  EXPECT_NEAR(first_step(true, 1e-9, 0.0), wholly, 1e-6 * wholly);
  // Halfway between two sets of the error and of the rate four rules fire by a quarter: 4 / 16.
  const double error = 1.25 * kRadPerDeg, rate = 0.375 * kRadPerDeg;
  EXPECT_NEAR(first_step(true, error, rate), 4.0 * first_step(false, error, rate), 1e-12);
}

TEST(StepAxis, CompositeAdaptationLearnsFromWhatThePredictionMissesAlone) {
  const auto learnt = [](double composite, double disturbance) {
    Loop loop(Adaptive([&](Adaptation& a) {
      a.composite = composite;
      a.predictor_1_s = 20.0;
    }));
    double error = 0.5 * kRadPerDeg, rate = 0.0;
    for (int i = 0; i < 50; ++i) {
      loop.Step(error, rate);
      // The error dynamics themselves, as the prediction steps them, under a disturbance.
      const double change = disturbance - (16.0 * error + 7.0 * rate);
      error += kTick_s * rate;
      rate += kTick_s * change;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < kFuzzyRules; ++i) sum += loop.FromStart(i);
    return sum;
  };
  EXPECT_NEAR(learnt(3.0, 0.0), learnt(0.0, 0.0), 1e-15) << "nothing is missed";
  EXPECT_GT(learnt(3.0, 0.02) - learnt(3.0, 0.0), 1.2 * (learnt(0.0, 0.02) - learnt(0.0, 0.0)));
}

AxisConfig Augmented() {
  AxisConfig config = SampleAxis(ControlLaw::kPdAac);
  config.augmentation = {.adaptive_gain_1_s = 4000.0,
                         .leakage_1_s = 0.5,
                         .spectral_gain_1_s = 1.0,
                         .high_pass_rad_s = 20.0,
                         .low_pass_rad_s = 5.0,
                         .minimum_total_gain = 0.5,
                         .maximum_total_gain = 2.0};
  return config;
}

TEST(StepAxis, AugmentationWithoutGainsIsPdBitForBit) {
  AxisConfig config = Augmented();
  config.augmentation.adaptive_gain_1_s = config.augmentation.spectral_gain_1_s = 0.0;
  Loop augmented(config), pd(SampleAxis(ControlLaw::kPd));
  Stream draws(5, 0, "errors");
  for (int i = 0; i < 500; ++i) {
    const double error = draws.Normal(), rate = draws.Normal();
    ASSERT_EQ(augmented.Step(error, rate), pd.Step(error, rate));
  }
}

TEST(StepAxis, AugmentedPidWithoutGainsIsPidBitForBit) {
  AxisConfig config = Augmented();
  config.law = ControlLaw::kPidAac;
  config.augmentation.adaptive_gain_1_s = config.augmentation.spectral_gain_1_s = 0.0;
  Loop augmented(config), pid(SampleAxis(ControlLaw::kPid));
  Stream draws(5, 0, "errors");
  for (int i = 0; i < 500; ++i) {
    const double error = draws.Normal(), rate = draws.Normal();
    ASSERT_EQ(augmented.Step(error, rate), pid.Step(error, rate));
  }
}

TEST(StepAxis, TheReferenceModelOfAnAugmentedPidIsItsOwnLoop) {
  AxisConfig config = Augmented();
  config.law = ControlLaw::kPidAac;
  config.augmentation.spectral_gain_1_s = 0.0;
  Loop loop(config);
  // Errors that follow the undisturbed loop, with the integral: there is no departure, so the gain stays.
  double error = 0.02, rate = 0.1;
  for (int i = 0; i < 400; ++i) {
    const double u = loop.Step(error, rate);
    rate -= kTick_s * u;
    error += kTick_s * rate;
  }
  EXPECT_NEAR(loop.state.total_gain, 1.0, 1e-12);
  EXPECT_GT(std::fabs(loop.state.model_integral_rad_s2), 1e-4);
}

TEST(StepAxis, AugmentationRaisesTheGainOnDepartureLowersItOnChatterAndStaysWithinItsBounds) {
  Loop departing(Augmented());
  for (int i = 0; i < 300; ++i) departing.Step(2.0 * kRadPerDeg, 0.0);
  EXPECT_GT(departing.state.total_gain, 1.05);
  for (int i = 0; i < 20000; ++i) departing.Step(0.5, 0.0);
  EXPECT_LE(departing.state.total_gain, 2.0);

  AxisConfig spectral = Augmented();
  spectral.augmentation.adaptive_gain_1_s = 0.0;
  Loop chattering(spectral);
  for (int i = 0; i < 300; ++i) chattering.Step(i % 2 ? 0.1 : -0.1, 0.0);
  EXPECT_LT(chattering.state.total_gain, 0.9);
  for (int i = 0; i < 5000; ++i) {
    chattering.Step(i % 2 ? 10.0 : -10.0, 0.0);
    ASSERT_GE(chattering.state.total_gain, 0.5);
  }
  EXPECT_LT(chattering.state.total_gain, 0.51);
}

TEST(StepAxis, AugmentationIsTheLawOfItsPaper) {
  const AdaptiveAugmentation a = Augmented().augmentation;
  Loop loop(Augmented());
  // At its first error the reference model starts: no departure, and the command is PD's.
  EXPECT_EQ(loop.Step(0.02, 0.1), std::fma(16.0, 0.02, 7.0 * 0.1));
  EXPECT_LT(loop.state.total_gain, 1.0) << "only the spectral damper has acted";
  // The model follows s² + kd s + kp from there: after this step, semi-implicit.
  const double model_rate = 0.1 - kTick_s * (16.0 * 0.02 + 7.0 * 0.1);
  const double model_error = 0.02 + kTick_s * model_rate;
  loop.state.total_gain = 1.3;
  loop.state.high_pass = 0.05;
  loop.state.low_pass = 0.04;
  const double command = 1.3 * (16.0 * 0.03 + 7.0 * 0.08);
  EXPECT_DOUBLE_EQ(loop.Step(0.03, 0.08), command);
  const double departure = 0.03 - model_error;
  const double fast = command - (0.05 + kTick_s * a.high_pass_rad_s * (command - 0.05));
  const double activity = 0.04 + kTick_s * a.low_pass_rad_s * (fast * fast - 0.04);
  // Floor 0.5, so k_a = 0.8 of k_max = 1.5.
  const double rate = (1.5 - 0.8) / 1.5 * a.adaptive_gain_1_s * departure * departure -
                      a.spectral_gain_1_s * 0.8 * activity - a.leakage_1_s * 0.3;
  EXPECT_NEAR(loop.state.total_gain, 1.3 + kTick_s * rate, 1e-15);
}

TEST(StepAxis, AugmentationLeaksBackToOne) {
  Loop loop(Augmented());
  loop.state.total_gain = 1.5;
  for (int i = 0; i < 200; ++i) loop.Step(0.0, 0.0);
  EXPECT_NEAR(loop.state.total_gain, 1.0 + 0.5 * std::pow(1.0 - kTick_s * 0.5, 200), 1e-12);
}

}  // namespace
}  // namespace dispersa::control_axis_test
