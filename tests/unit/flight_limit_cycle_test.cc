// The limit cycle's measure on made-up histories with and without one.
#include "core/flight/limit_cycle.h"

#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::flight_limit_cycle_test {
namespace {

constexpr double kTick_s = 0.01;
using History = std::function<double(double)>;

// Peak to peak found in the pitch channel, in the unit of the history.
double Found(double seconds, const History& history, double tick_s = kTick_s) {
  LimitCycleMeter meter(tick_s);
  const long ticks = std::lround(seconds / tick_s);
  for (long i = 0; i < ticks; ++i) {
    const double t = static_cast<double>(i) * tick_s;
    meter.Add(0.0, kRadPerDeg * history(t), 0.0);
  }
  return meter.worst_rad() * kDegPerRad;
}

double Phase(double f, double t) { return f * t - std::floor(f * t); }

// ---- with a cycle
// ------------------------------------------------------------------------------------------

TEST(LimitCycle, ASineHasItsPeakToPeak) {
  for (const double f : {0.35, 0.5, 0.8, 1.0, 1.25, 2.0, 2.5, 3.3, 5.0, 7.0, 9.5}) {
    // Above a few hertz the correction for the means holds to a percent or two.
    EXPECT_NEAR(Found(60.0, [f](double t) { return 0.5 * std::sin(kTwoPi * f * t); }), 1.0, 0.02) << f;
  }
}

TEST(LimitCycle, IsTheSameForOtherTicks) {
  const History sine = [](double t) { return 0.5 * std::sin(kTwoPi * 1.7 * t); };
  for (const double tick_s : {0.0025, 0.005, 0.02})
    EXPECT_NEAR(Found(40.0, sine, tick_s), 1.0, 0.01) << tick_s;
}

TEST(LimitCycle, ASawToothHasMostOfItsOwn) {
  // Four harmonics of a triangle reach 0.9 of its peak to peak; of a saw-tooth and a relay's square they
  // overshoot by Gibbs' share, 18 % of the half jump on either side and what short sums add.
  for (const double f : {0.5, 1.0, 2.3, 4.0}) {
    EXPECT_NEAR(Found(60.0, [f](double t) { return std::fabs(2.0 * Phase(f, t) - 1.0); }), 0.9, 0.03) << f;
    EXPECT_NEAR(Found(60.0, [f](double t) { return Phase(f, t); }), 1.0, 0.2) << f;
    EXPECT_NEAR(Found(60.0, [f](double t) { return Phase(f, t) < 0.5 ? 0.0 : 1.0; }), 1.2, 0.17) << f;
  }
}

TEST(LimitCycle, AGrowingOscillationCounts) {
  // 6 % a period; at its end it has grown to 1.
  for (const double f : {0.5, 2.0, 4.5}) {
    const double found = Found(60.0, [f](double t) {
      return 0.5 * std::exp(0.01 * kTwoPi * f * (t - 60.0)) * std::sin(kTwoPi * f * t);
    });
    EXPECT_GT(found, 0.3) << f;
    EXPECT_LT(found, 1.0) << f;
  }
}

TEST(LimitCycle, ACycleThatSlowlyChangesItsFrequencyCounts) {
  EXPECT_NEAR(Found(60.0, [](double t) { return 0.5 * std::sin(kTwoPi * 1.5 * t * (1.0 + 0.1 * t / 60.0)); }),
              1.0, 0.05);
}

TEST(LimitCycle, IsFoundUnderAChangingTrim) {
  EXPECT_NEAR(Found(60.0,
                    [](double t) {
                      return 0.1 * t - 2.0 * std::sin(kTwoPi * t / 50.0) + 0.1 * std::sin(kTwoPi * 2.0 * t);
                    }),
              0.2, 0.01);
}

TEST(LimitCycle, IsFoundInNoise) {
  // White in every tick, with as much power as the sine and with four times as much: noise adds to the peak
  // to peak.
  for (const double f : {0.5, 1.0, 2.0}) {
    for (const double ratio : {1.0, 0.25}) {
      int found = 0;
      for (unsigned seed = 0; seed < 20; ++seed) {
        Stream noise(seed, 0, "noise");
        const double sigma = 0.5 / std::sqrt(2.0 * ratio);
        const double cycle =
            Found(50.0, [&](double t) { return 0.5 * std::sin(kTwoPi * f * t) + sigma * noise.Normal(); });
        found += cycle > 0.9;
        EXPECT_LT(cycle, 1.5);
      }
      EXPECT_EQ(found, 20) << f << " Hz, signal to noise " << ratio;
    }
  }
}

TEST(LimitCycle, EveryChannelCounts) {
  for (int channel = 0; channel < 3; ++channel) {
    LimitCycleMeter meter(kTick_s);
    for (int i = 0; i < 2000; ++i) {
      double values[3] = {};
      values[channel] = 0.01 * std::sin(kTwoPi * 2.0 * i * kTick_s);
      meter.Add(values[0], values[1], values[2]);
    }
    EXPECT_NEAR(meter.worst_rad(), 0.02, 4e-4) << channel;
  }
}

// The criterion is the amplitude in the last third of a window over that in the first: at least 0.7. At 1.8
// Hz a window lasts 9.6 s, and its outer thirds lie 6.4 s apart.
TEST(LimitCycle, MayLoseThreeTenthsOfItsAmplitudeWithinAWindow) {
  const auto found = [](double ratio) {
    return Found(60.0,
                 [ratio](double t) { return 0.5 * std::pow(ratio, t / 6.4) * std::sin(kTwoPi * 1.8 * t); });
  };
  EXPECT_GT(found(0.77), 0.7);
  EXPECT_EQ(found(0.63), 0.0);
}

// ---- without
// ------------------------------------------------------------------------------------------------

TEST(LimitCycle, NothingIsSaidWithoutAWindow) {
  const History sine = [](double t) { return std::sin(kTwoPi * 6.0 * t); };
  EXPECT_LT(Found(2.39, sine), 0.0);
  EXPECT_GT(Found(2.41, sine), 1.9);
  LimitCycleMeter meter(kTick_s);
  for (int i = 0; i < 2000; ++i) {
    if (i % 230 == 0) meter.Interrupt();
    meter.Add(0.0, std::sin(kTwoPi * 6.0 * i * kTick_s), 0.0);
  }
  EXPECT_LT(meter.worst_rad(), 0.0);
}

TEST(LimitCycle, RampsDriftsAndStepsAreNone) {
  EXPECT_EQ(Found(60.0, [](double t) { return 3.0 * t - 7.0; }), 0.0);
  EXPECT_EQ(Found(60.0, [](double t) { return 5.0 * std::sin(kTwoPi * t / 40.0); }), 0.0);
  EXPECT_EQ(Found(60.0, [](double t) { return t < 20.0 ? 0.0 : 1.0; }), 0.0);
  EXPECT_EQ(Found(60.0, [](double t) { return std::floor(t / 7.3); }), 0.0);
}

TEST(LimitCycle, DecayingTransientsAreNone) {
  for (const double f : {0.4, 1.0, 2.3, 6.0})
    for (const double zeta : {0.02, 0.05, 0.1, 0.3})
      EXPECT_EQ(Found(60.0,
                      [=](double t) {
                        const double since = t - 10.0;
                        return since < 0.0
                                   ? 0.0
                                   : std::exp(-zeta * kTwoPi * f * since) * std::sin(kTwoPi * f * since);
                      }),
                0.0)
          << f << " Hz, damping " << zeta;
}

TEST(LimitCycle, ABurstIsNone) {
  // Five periods between 20 and 22.5 s.
  EXPECT_EQ(Found(60.0, [](double t) { return t > 20.0 && t < 22.5 ? std::sin(kTwoPi * 2.0 * t) : 0.0; }),
            0.0);
}

TEST(LimitCycle, TonesFasterThanItMeasuresAreNone) {
  for (const double f : {17.0, 30.0, 50.0})
    EXPECT_LT(Found(20.0, [f](double t) { return std::cos(kTwoPi * f * t); }), 0.1) << f;
}

// A mode of a damping driven by white noise, of deviation 1: what a closed loop makes of turbulence.
// Semi-implicit Euler in quarter ticks.
bool RaisesFalsely(double f, double zeta, unsigned seed) {
  constexpr int kParts = 4;
  constexpr double kStep_s = kTick_s / kParts;
  const double w = kTwoPi * f, drive = std::sqrt(4.0 * zeta * w * w * w * kStep_s);
  Stream noise(seed, 0, "mode");
  double x = 0.0, v = 0.0;
  LimitCycleMeter meter(kTick_s);
  for (int i = 0; i < 5000; ++i) {
    for (int k = 0; k < kParts; ++k) {
      v += drive * noise.Normal() - kStep_s * (w * w * x + 2.0 * zeta * w * v);
      x += kStep_s * v;
    }
    meter.Add(0.0, kRadPerDeg * x, 0.0);
  }
  return meter.worst_rad() > 0.0;
}

TEST(LimitCycle, TheAnswerOfADampedLoopToNoiseIsNone) {
  struct Case {
    double f, zeta;
    int allowed;  // of 100 burns of 50 s
  };
  // The estimate of limit_cycle.h by window, times the windows of a burn: none for a damping of 0.15 and
  // more, one in some hundred at 0.1 below 3 Hz; higher modes fill more windows.
  for (const Case& c : {Case{0.4, 0.15, 0}, Case{1.0, 0.15, 0}, Case{2.0, 0.15, 0}, Case{6.0, 0.3, 0},
                        Case{1.0, 0.5, 0}, Case{0.4, 0.1, 2}, Case{1.0, 0.1, 2}, Case{2.0, 0.1, 2}}) {
    int raised = 0;
    for (unsigned seed = 0; seed < 100; ++seed) raised += RaisesFalsely(c.f, c.zeta, seed);
    EXPECT_LE(raised, c.allowed) << c.f << " Hz, damping " << c.zeta;
  }
}

TEST(LimitCycle, ALoopThatHardlyDampsCannotBeToldFromOne) {
  int raised = 0;
  for (unsigned seed = 0; seed < 20; ++seed) raised += RaisesFalsely(2.0, 0.005, seed);
  EXPECT_GE(raised, 15);
}

}  // namespace
}  // namespace dispersa::flight_limit_cycle_test
