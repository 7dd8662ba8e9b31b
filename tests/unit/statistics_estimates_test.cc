// Every interval contains its own estimate, for any sample, percentile and confidence.
#include "core/random/draws.h"
#include "core/statistics/anytime.h"
#include "core/statistics/intervals.h"
#include "core/statistics/paired.h"
#include "core/statistics/percentiles.h"
#include "core/statistics/planned_verdict.h"
#include "core/statistics/replicates.h"
#include "core/statistics/sensitivity.h"
#include "core/statistics/summary.h"
#include "core/statistics/two_samples.h"
#include "tests/test.h"

namespace dispersa::statistics_estimates_test {

/// Allowance for the rounding of a root, or of an inverse of the beta function.
constexpr double kRounding = 1e-12;

void ExpectHolds(const Interval& interval, double estimate, const std::string& what) {
  EXPECT_LE(interval.lower, estimate + kRounding) << what;
  EXPECT_GE(interval.upper, estimate - kRounding) << what;
}

/// `n` skewed values, the same ones for the same name; of even `seed` all negative.
std::vector<double> Sample(std::size_t n, const char* name, std::uint64_t seed) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < n; ++k)
    values.push_back((seed % 2 == 0 ? -1.0 : 1.0) * std::exp(Stream(seed, k, name).Normal()));
  return values;
}

TEST(Estimates, OfAProbabilityLieInsideItsLimits) {
  for (const std::int64_t n : {1, 2, 7, 40, 1000}) {
    for (std::int64_t events = 0; events <= n; events += std::max<std::int64_t>(1, n / 40)) {
      const double share = static_cast<double>(events) / static_cast<double>(n);
      const std::string what = std::to_string(events) + " of " + std::to_string(n);
      for (const double confidence : {0.6, 0.95, 0.999}) {
        const Interval limits = ClopperPearson(events, n, confidence);
        ExpectHolds(limits, share, what);
        // Counting what did not happen turns the limits round.
        const Interval mirrored = ClopperPearson(n - events, n, confidence);
        EXPECT_NEAR(mirrored.lower, 1.0 - limits.upper, kRounding) << what;
        // Without an event, and with nothing else, the limit is in closed form: (1 - p)^n = the tail.
        if (events == 0) {
          EXPECT_NEAR(limits.upper, 1.0 - std::pow(0.5 - 0.5 * confidence, 1.0 / static_cast<double>(n)),
                      kRounding);
        }
      }
      for (const double risk : {0.01, 0.1, 0.3}) {
        const Interval success = AnytimeSuccess(n, events, events, risk);
        ExpectHolds(success, 1.0 - share, what + " failed, at any time");
        PlannedRequirement requirement{.probability = 0.9, .risk = risk, .plan = {}, .planned = n};
        CaseTally tally;
        for (std::int64_t i = 0; i < events; ++i) tally.failed.push_back(i);
        const PlannedVerdict verdict = Decide(requirement, n, tally);
        ExpectHolds({verdict.success_lower, verdict.success_upper}, 1.0 - share, what + " failed, by a plan");
      }
    }
  }
}

TEST(Estimates, OfReplicatesLieInsideTheirBounds) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Stream stream(seed, 0, "replicates");
    std::vector<std::int64_t> counts;
    double events = 0.0;
    for (std::size_t k = 0; k < 2 + seed % 9; ++k) {
      counts.push_back(
          static_cast<std::int64_t>(21.0 * stream.Uniform() * static_cast<double>(seed % 4) / 3.0));
      events += static_cast<double>(counts.back());
    }
    ExpectHolds(ReplicateBounds(counts, 20, 0.1), events / (20.0 * static_cast<double>(counts.size())),
                std::to_string(seed));
  }
}

TEST(Estimates, OfPercentilesLieInsideTheirLimits) {
  for (const std::size_t n : {1, 5, 30, 200, 2000}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const std::vector<double> sorted = SortedFinite(Sample(n, "percentiles", seed));
      for (const Percentile& one : Percentiles(sorted)) {
        if (std::isfinite(one.estimate)) ExpectHolds(one.limits, one.estimate, one.name);
        EXPECT_LE(one.limits.lower, one.limits.upper) << one.name;
      }
    }
  }
}

TEST(Estimates, OfADifferenceLieInsideItsInterval) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const std::size_t n : {6, 25, 300}) {
      std::vector<double> a = Sample(n, "a", seed), b = Sample(n, "b", seed + seed / 4);
      const std::string what = std::to_string(n) + " cases, seed " + std::to_string(seed);
      for (const double confidence : {0.8, 0.95, 0.99}) {
        for (const bool paired : {true, false}) {
          for (const double probability : {0.05, 0.5, 0.95}) {
            const QuantileDifference d = CompareQuantiles(a, b, probability, confidence, paired);
            if (std::isfinite(d.difference)) ExpectHolds(d.interval, d.difference, what);
          }
        }
        const PairedDifference paired = ComparePaired(a, b, confidence);
        ExpectHolds(paired.difference_interval, paired.median_difference, what);
        if (std::isfinite(paired.median_ratio)) ExpectHolds(paired.ratio_interval, paired.median_ratio, what);
        // A pair that one of them lost is infinitely bad, and still inside.
        std::vector<double> lost = b;
        lost[0] = kUndefined;
        const PairedDifference with_loss = ComparePaired(a, lost, confidence);
        ExpectHolds(with_loss.difference_interval, with_loss.median_difference, what + ", one lost");
      }
    }
  }
}

TEST(Estimates, OfAnIndexLieInsideItsInterval) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<double> x = Sample(300, "x", seed), noise = Sample(300, "noise", seed + 1);
    std::vector<double> y;
    for (std::size_t k = 0; k < x.size(); ++k)
      y.push_back(static_cast<double>(seed) / 10.0 * x[k] + noise[k]);
    const SensitivityIndex index = FirstOrderIndex(x, y);
    EXPECT_LE(index.low, index.index) << seed;
    EXPECT_GE(index.high, index.index) << seed;
  }
}

}  // namespace dispersa::statistics_estimates_test
