// Margins of sampled loops whose critical gain is known in closed form, and of the autopilot's own code.
#include "core/margins/loop_margins.h"

#include "core/control/axis_controller.h"
#include "core/math/constants.h"
#include "core/math/matrices.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::margins_loop_test {
namespace {

constexpr double kTick_s = 0.01;

double Db(double ratio) { return 20.0 * std::log10(ratio); }

// Acceleration follows the command at once; the actuator's states are idle.
AxisPlant DoubleIntegrator() {
  AxisPlant plant;
  plant.a(0, 1) = 1.0;
  plant.a(2, 2) = plant.a(3, 3) = -1.0;
  plant.b[1] = 1.0;
  return plant;
}

AxisPlant WithActuator(double bandwidth, double aerodynamic = 0.0, double effectiveness = 5.0) {
  AxisPlant plant;
  plant.a(0, 1) = plant.a(2, 3) = 1.0;
  plant.a(1, 0) = aerodynamic;
  plant.a(1, 2) = effectiveness;
  plant.a(3, 2) = -bandwidth * bandwidth;
  plant.a(3, 3) = -1.4 * bandwidth;
  plant.b[3] = bandwidth * bandwidth;
  return plant;
}

TEST(SampledLoop, DoubleIntegratorWithPdAndNoDelayIsLostAtTheSampling) {
  // z² + (K kp T²/2 + K kd T - 2) z + 1 + K kp T²/2 - K kd T: Jury's first condition to fail is P(-1) > 0,
  // at K = 2 / (kd T); no gain is too small.
  LinearLaw law;
  law.kp_1_s2 = 16.0;
  law.kd_1_s = 7.0;
  law.effectiveness_1_s2 = 1.0;
  const LoopMargins m = SampledLoop(DoubleIntegrator(), law, kTick_s, 0).Margins();
  ASSERT_TRUE(m.stable);
  EXPECT_NEAR(m.gain_up_db, Db(2.0 / (7.0 * kTick_s)), 1e-9);
  EXPECT_TRUE(std::isinf(m.gain_down_db));
}

TEST(SampledLoop, RateLoopWithDelaysHasTheClosedFormMargins) {
  // L = kd T / (z^d (z - 1)): of phase -w T (d + 1/2) - 90° and modulus kd T / (2 sin(w T / 2)). The attitude
  // is made to decay, so that the loop that nothing feeds it back to is stable.
  AxisPlant plant = DoubleIntegrator();
  plant.a(0, 0) = -1.0;
  for (const int delay : {1, 2, 5}) {
    for (const double kd : {1.0, 5.0}) {
      LinearLaw law;
      law.kd_1_s = kd;
      law.effectiveness_1_s2 = 1.0;
      const LoopMargins m = SampledLoop(plant, law, kTick_s, delay).Margins();
      ASSERT_TRUE(m.stable);
      const double turn = delay + 0.5;
      EXPECT_NEAR(m.gain_up_db, Db(2.0 * std::sin(0.25 * kPi / turn) / (kd * kTick_s)), 1e-9);
      const double crossover = 2.0 / kTick_s * std::asin(0.5 * kd * kTick_s);
      const double phase = 0.5 * kPi - turn * crossover * kTick_s;
      EXPECT_NEAR(m.crossover_rad_s, crossover, 1e-9);
      EXPECT_NEAR(m.phase_deg, phase * kDegPerRad, 1e-8);
      EXPECT_NEAR(m.delay_s, phase / crossover, 1e-10);
    }
  }
}

// A body that its air holds, with a rate loop: the gain rises through 0 dB below the body's frequency and
// falls through it above. Below, the response leads by 90 degrees and what the filter adds: it is less than a
// half turn from -1 clockwise.
TEST(SampledLoop, PhaseMarginCountsTheNearerWayToTheCriticalPoint) {
  AxisPlant plant = WithActuator(100.0, -9.0, 1.0);
  plant.a(1, 1) = -0.5;
  LinearLaw law;
  law.kd_1_s = 3.0;
  law.effectiveness_1_s2 = 1.0;
  const double high_pass_rad_s = 2.0, below = 2.0 + high_pass_rad_s * kTick_s;
  law.filters = {{2.0 / below, -2.0 / below, 0.0, -(2.0 - high_pass_rad_s * kTick_s) / below, 0.0}};
  const SampledLoop loop(plant, law, kTick_s, 1);
  const LoopMargins m = loop.Margins();
  ASSERT_TRUE(m.stable);
  double low = 0.5, high = 3.0;  // rad/s
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::abs(loop.Response(middle)) < 1.0 ? low : high) = middle;
  }
  const double lead_deg = std::arg(loop.Response(low)) * kDegPerRad;
  ASSERT_GT(lead_deg, 110.0);
  EXPECT_NEAR(m.phase_deg, 180.0 - lead_deg, 1e-6);
  EXPECT_GT(m.crossover_rad_s, 3.0);
}

TEST(SampledLoop, AerodynamicInstabilityBoundsTheGainFromBelow) {
  // Steady state: the stiffness kp / b * b must exceed the aerodynamic one.
  LinearLaw law;
  law.kp_1_s2 = 16.0;
  law.kd_1_s = 7.0;
  law.effectiveness_1_s2 = 5.0;
  const LoopMargins m = SampledLoop(WithActuator(25.0, 3.0), law, kTick_s, 1).Margins();
  ASSERT_TRUE(m.stable);
  EXPECT_NEAR(m.gain_down_db, Db(16.0 / 3.0), 1e-6);
  // Stable by its air and damped, the body needs no gain at all.
  AxisPlant stable = WithActuator(25.0, -3.0);
  stable.a(1, 1) = -0.1;
  EXPECT_TRUE(std::isinf(SampledLoop(stable, law, kTick_s, 1).Margins().gain_down_db));
}

TEST(SampledLoop, AnUnstableLoopHasNoMargins) {
  LinearLaw law;
  law.kp_1_s2 = 1.0;
  law.kd_1_s = 7.0;
  law.effectiveness_1_s2 = 5.0;
  const LoopMargins m = SampledLoop(WithActuator(25.0, 3.0), law, kTick_s, 1).Margins();
  EXPECT_FALSE(m.stable);
  EXPECT_EQ(m.gain_up_db, 0.0);
  EXPECT_EQ(m.phase_deg, 0.0);
  EXPECT_EQ(m.delay_s, 0.0);
}

LinearLaw AdaptingLaw(double kp, double kd, double gamma) {
  LinearLaw law;
  law.kp_1_s2 = kp;
  law.kd_1_s = kd;
  law.effectiveness_1_s2 = 5.0;
  law.drive_error = gamma * 0.02;
  law.drive_rate = gamma * 0.004;
  law.spread_1_s = 60.0;
  law.rules = kFuzzyRules;
  return law;
}

TEST(SampledLoop, TheClosedLoopIsCriticalWhereTheResponseSaysSo) {
  // Gain margins come from the frequency response, stability from eigenvalues of the closed loop.
  for (const double gamma : {0.0, 8000.0}) {
    for (const double aerodynamic : {0.0, 3.0}) {
      const SampledLoop loop(WithActuator(25.0, aerodynamic), AdaptingLaw(16.0, 7.0, gamma), kTick_s, 1);
      const LoopMargins m = loop.Margins();
      ASSERT_TRUE(m.stable);
      const double up = std::pow(10.0, m.gain_up_db / 20.0);
      EXPECT_LT(loop.SpectralRadius(up * (1.0 - 1e-6)), 1.0);
      EXPECT_GT(loop.SpectralRadius(up * (1.0 + 1e-6)), 1.0);
      if (std::isinf(m.gain_down_db)) continue;
      const double down = std::pow(10.0, -m.gain_down_db / 20.0);
      EXPECT_LT(loop.SpectralRadius(down * (1.0 + 1e-6)), 1.0);
      EXPECT_GT(loop.SpectralRadius(down * (1.0 - 1e-6)), 1.0);
    }
  }
}

TEST(SampledLoop, CompositeAdaptationIsCriticalWhereTheResponseSaysSo) {
  LinearLaw law = AdaptingLaw(16.0, 7.0, 8000.0);
  const double without_db = SampledLoop(WithActuator(25.0), law, kTick_s, 1).Margins().gain_up_db;
  law.drive_prediction = 1.0 * law.drive_rate;
  law.predictor_1_s = 15.0;
  const SampledLoop loop(WithActuator(25.0), law, kTick_s, 1);
  const LoopMargins m = loop.Margins();
  ASSERT_TRUE(m.stable);
  EXPECT_GT(std::fabs(m.gain_up_db - without_db), 0.05) << "it counts";
  const double up = std::pow(10.0, m.gain_up_db / 20.0);
  EXPECT_LT(loop.SpectralRadius(up * (1.0 - 1e-6)), 1.0);
  EXPECT_GT(loop.SpectralRadius(up * (1.0 + 1e-6)), 1.0);
}

TEST(SampledLoop, FiltersTurnTheResponseAndMoveTheCriticalGain) {
  LinearLaw law;
  law.kp_1_s2 = 16.0;
  law.kd_1_s = 7.0;
  law.effectiveness_1_s2 = 5.0;
  const AxisPlant plant = WithActuator(25.0);
  const SampledLoop bare(plant, law, kTick_s, 1);
  law.filters = {
      Discretise({.poles_rad_s = 40.0, .poles_damping = 0.7}, kTick_s),
      Discretise({.zeros_rad_s = 30.0, .zeros_damping = 0.1, .poles_rad_s = 30.0, .poles_damping = 0.5},
                 kTick_s)};
  const SampledLoop filtered(plant, law, kTick_s, 1);
  for (const double w : {0.1, 3.0, 30.0, 200.0}) {
    const std::complex<double> z = std::polar(1.0, w * kTick_s);
    std::complex<double> h = 1.0;
    for (const DigitalSection& f : law.filters)
      h *= (f.b0 * z * z + f.b1 * z + f.b2) / (z * z + f.a1 * z + f.a2);
    EXPECT_LT(std::abs(filtered.Response(w) / (h * bare.Response(w)) - 1.0), 1e-9) << w;
  }
  const LoopMargins m = filtered.Margins();
  ASSERT_TRUE(m.stable);
  EXPECT_LT(m.gain_up_db, bare.Margins().gain_up_db - 1.0);
  EXPECT_NEAR(filtered.SpectralRadius(std::pow(10.0, m.gain_up_db / 20.0)), 1.0, 1e-9);
  EXPECT_GT(filtered.SpectralRadius(std::pow(10.0, (m.gain_up_db + 0.1) / 20.0)), 1.0);
}

// A body with a mode that a gyro feels: 5 Hz, 1 % damped, driven by the nozzle.
AxisPlant Bending(double slope) {
  AxisPlant plant = WithActuator(25.0, 3.0);
  const Eigen::MatrixXd rigid = plant.a;
  plant.a = Eigen::MatrixXd::Zero(6, 6);
  plant.a.topLeftCorner(4, 4) = rigid;
  plant.b.conservativeResize(6);
  plant.b[4] = plant.b[5] = 0.0;
  const double w = 31.4;
  plant.a(4, 5) = 1.0;
  plant.a(5, 2) = 20.0;
  plant.a(5, 4) = -w * w;
  plant.a(5, 5) = -0.02 * w;
  plant.attitude = Eigen::RowVectorXd::Unit(6, 0);
  plant.attitude[4] = 0.3 * slope;
  Eigen::RowVectorXd rate = Eigen::RowVectorXd::Unit(6, 1);
  rate[5] = slope;
  plant.rates = {{rate, {.b0 = 0.2, .b1 = 0.5, .b2 = 0.1, .a1 = -0.3, .a2 = 0.1}, 0.6, 2.0},
                 {Eigen::RowVectorXd::Unit(6, 1), {}, 0.4, 0.0}};
  plant.lowest_mode_rad_s = w;
  return plant;
}

TEST(SampledLoop, OfABodyThatBendsIsCriticalWhereTheResponseSaysSo) {
  for (const double slope : {0.0, 0.01, -0.01, -0.04}) {
    for (const double gamma : {0.0, 8000.0}) {
      const SampledLoop loop(Bending(slope), AdaptingLaw(9.0, 5.0, gamma), kTick_s, 1);
      const LoopMargins m = loop.Margins();
      ASSERT_TRUE(m.stable) << slope;
      for (const double db : {m.gain_up_db, -m.gain_down_db}) {
        if (std::isinf(db)) continue;
        EXPECT_NEAR(loop.SpectralRadius(std::pow(10.0, db / 20.0)), 1.0, 1e-9) << slope << " " << gamma;
      }
    }
  }
}

TEST(SampledLoop, ABendingModeThatIsNotFeltChangesNothing) {
  AxisPlant unfelt = Bending(0.0);
  unfelt.rates = {{Eigen::RowVectorXd::Unit(6, 1), {}, 1.0, 0.0}};
  const LinearLaw law = AdaptingLaw(9.0, 5.0, 8000.0);
  const SampledLoop bent(unfelt, law, kTick_s, 1), rigid(WithActuator(25.0, 3.0), law, kTick_s, 1);
  for (const double w : {0.05, 1.0, 5.0, 31.4, 200.0})
    EXPECT_LT(std::abs(bent.Response(w) / rigid.Response(w) - 1.0), 1e-9) << w;
  const LoopMargins a = bent.Margins(), b = rigid.Margins();
  EXPECT_NEAR(a.gain_up_db, b.gain_up_db, 1e-6);
  EXPECT_NEAR(a.phase_deg, b.phase_deg, 1e-6);
}

TEST(SampledLoop, TheBendingPeakIsTheResponsesAndItsPhaseCountsWhereItIsHigh) {
  const LinearLaw law = AdaptingLaw(9.0, 5.0, 0.0);
  double last_db = -100.0;
  for (const double slope : {-0.05, -0.1, -0.3, -1.0}) {
    const SampledLoop loop(Bending(slope), law, kTick_s, 1);
    const LoopMargins m = loop.Margins();
    double peak = 0.0, least_deg = 180.0;
    for (double w = 0.7 * 31.4; w < 314.0; w *= 1.000005) {
      const std::complex<double> l = loop.Response(w);
      peak = std::max(peak, std::abs(l));
      // Its edges among them, wherever they fall between the frequencies at which Margins() looks.
      if (std::abs(l) >= std::pow(10.0, -0.3))
        least_deg = std::min(least_deg, 180.0 / kPi * std::abs(std::arg(-l)));
    }
    EXPECT_NEAR(m.bending_peak_db, 20.0 * std::log10(peak), 0.02) << slope;
    ASSERT_TRUE(m.stable);
    EXPECT_NEAR(m.bending_phase_6db_deg, least_deg, 0.015) << slope;
    EXPECT_GT(m.bending_peak_db, last_db);
    last_db = m.bending_peak_db;
  }
  EXPECT_GT(last_db, 10.0);
}

TEST(SampledLoop, IsStableForAsManyTicksMoreAsTheDelayMarginAllows) {
  for (const double gamma : {0.0, 8000.0}) {
    const AxisPlant plant = WithActuator(25.0);
    const LinearLaw law = AdaptingLaw(16.0, 7.0, gamma);
    const double margin_ticks = SampledLoop(plant, law, kTick_s, 1).Margins().delay_s / kTick_s;
    ASSERT_GT(margin_ticks, 2.0);
    const int allowed = static_cast<int>(margin_ticks);
    EXPECT_LT(SampledLoop(plant, law, kTick_s, 1 + allowed).SpectralRadius(1.0), 1.0);
    EXPECT_GT(SampledLoop(plant, law, kTick_s, 2 + allowed).SpectralRadius(1.0), 1.0);
  }
}

// Growth of the attitude over the second half of a run of the autopilot's own code on the sampled plant.
double Growth(const AxisPlant& plant, const AxisLaw& axis, double effectiveness, double gain) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(5, 5);
  m.topLeftCorner<4, 4>() = plant.a * kTick_s;
  m.topRightCorner<4, 1>() = plant.b * kTick_s;
  const Eigen::MatrixXd held = MatrixExponential(m);
  Eigen::Vector4d x(1e-9, 0.0, 0.0, 0.0);  // so small that the law is linear
  AxisState state;
  AxisTelemetry telemetry;
  double command = 0.0, early = 0.0, late = 0.0;
  constexpr int kTicks = 4000;
  for (int k = 0; k < kTicks; ++k) {
    const double u = StepAxis(axis, 0, -x[0], -x[1], 1.0, 1.0, kTick_s, state, telemetry);
    x = held.topLeftCorner<4, 4>() * x + held.topRightCorner<4, 1>() * command;
    command = gain * u / effectiveness;
    (k < kTicks / 2 ? early : late) += x[0] * x[0];
  }
  return late / early;
}

// With composite adaptation where `composite` is not 0.
void ExpectLostWherePredicted(double composite) {
  AxisConfig config = SampleAxis(ControlLaw::kAdaptiveFuzzy);
  config.adaptation.composite = composite;
  config.adaptation.predictor_1_s = 15.0;
  config.adaptation.gamma = {8000.0, 8000.0};
  config.adaptation.spread_1_s = 60.0;
  config.adaptation.leakage_1_s = 0.05;
  const AxisLaw axis = BuildAxisLaw(config, kTick_s);
  LinearLaw law = AdaptingLaw(16.0, 7.0, 0.0);
  law.drive_error = 8000.0 * axis.stages[0].pn_error;
  law.drive_rate = 8000.0 * axis.stages[0].pn_rate;
  law.leakage_1_s = 0.05;
  law.drive_prediction = composite * law.drive_rate;
  law.predictor_1_s = 15.0;
  const AxisPlant plant = WithActuator(25.0);
  const LoopMargins m = SampledLoop(plant, law, kTick_s, 1).Margins();
  ASSERT_TRUE(m.stable);
  // The frozen loop would bear 1.2 dB more: the adaptation counts.
  LinearLaw frozen = law;
  frozen.drive_error = frozen.drive_rate = frozen.drive_prediction = 0.0;
  ASSERT_GT(SampledLoop(plant, frozen, kTick_s, 1).Margins().gain_up_db, m.gain_up_db + 0.5);
  for (const double db : {m.gain_up_db, -m.gain_down_db}) {
    const double critical = std::pow(10.0, db / 20.0);
    const double inside = db > 0.0 ? 0.97 : 1.03;
    EXPECT_LT(Growth(plant, axis, 5.0, critical * inside), 1.0) << db;
    EXPECT_GT(Growth(plant, axis, 5.0, critical / inside), 1.0) << db;
  }
}
TEST(SampledLoop, PredictsWhereTheAdaptiveFuzzyLawItselfIsLost) { ExpectLostWherePredicted(0.0); }
TEST(SampledLoop, PredictsWhereTheCompositeAdaptiveLawItselfIsLost) { ExpectLostWherePredicted(1.0); }

}  // namespace
}  // namespace dispersa::margins_loop_test
