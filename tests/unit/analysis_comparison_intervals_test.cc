// Every number of a comparison lies inside its interval, for any sense of its metric and any direction of the
// change.
#include "core/random/draws.h"
#include "core/statistics/intervals.h"
#include "tests/test.h"
#include "tests/unit/comparison_sample.h"

namespace dispersa::analysis_comparison_intervals_test {
namespace {

using namespace comparison_sample;

constexpr std::size_t kCases = 80;

/// Every metric of 80 flights: about 11, and `moved` times as much as 0.7 to 1.3 more. Those that are worse
/// farther from zero take both signs. Flights of different `draws` have other inputs, and so are no pairs.
CaseColumns Flights(double moved, const std::string& draws) {
  std::vector<std::uint64_t> index;
  std::vector<double> input;
  for (std::size_t k = 0; k < kCases; ++k) {
    index.push_back(k);
    input.push_back(Stream(1, k, draws).Uniform());
  }
  CaseColumns cases = Columns(index, input, input);
  for (std::size_t i = 0; i < cases.metrics.size(); ++i) {
    const Metric& metric = Metrics()[i];
    for (std::size_t k = 0; k < kCases; ++k) {
      const double before = 10.0 + std::exp(Stream(2, k, draws + metric.name).Normal());
      const double value = before + moved * (0.7 + 0.6 * Stream(3, k, draws + metric.name).Uniform());
      cases.metrics[i][k] = metric.worse == Worse::kFartherFromZero && k % 2 == 0 ? -value : value;
    }
  }
  return cases;
}

/// b against a in every metric.
Comparison CompareAll(const CaseColumns& a, const CaseColumns& b) {
  return CompareColumns(a, b, {}, {MetricNames().begin(), MetricNames().begin() + std::ssize(a.metrics)});
}

void ExpectHolds(const Interval& interval, double estimate, const std::string& what) {
  EXPECT_LE(interval.lower, estimate) << what;
  EXPECT_GE(interval.upper, estimate) << what;
}

struct Sides {
  const char* name;
  const char* draws_of_b;  ///< those of A are "a"
  double moved;            ///< of B
};
void PrintTo(const Sides& sides, std::ostream* out) { *out << sides.name; }

class ComparisonOfEveryMetric : public testing::TestWithParam<Sides> {};

TEST_P(ComparisonOfEveryMetric, HoldsItsEstimates) {
  const CaseColumns a = Flights(0.0, "a"), b = Flights(GetParam().moved, GetParam().draws_of_b);
  const Comparison comparison = CompareAll(a, b);
  FlightKind kind = AnyUnder(ControlLaw::kAdaptiveFuzzy);
  kind.has_limits = false;
  ASSERT_EQ(comparison.metrics.size(), MetricsUnder(kUsualStages, kind).size());
  EXPECT_EQ(comparison.pairing.paired, std::string(GetParam().draws_of_b) == "a");
  for (const MetricComparison& metric : comparison.metrics) {
    ASSERT_TRUE(std::isfinite(metric.difference)) << metric.metric;
    EXPECT_LT(metric.interval.lower, metric.interval.upper) << metric.metric;
    ExpectHolds(metric.interval, metric.difference, metric.metric);
    EXPECT_GT(metric.difference * GetParam().moved, 0.0) << metric.metric;  // in the metric's own direction
    if (std::isfinite(metric.ratio))
      ExpectHolds(metric.ratio_interval, metric.ratio, metric.metric + ", ratio");
    std::size_t reached = 0;
    for (const PercentileComparison& tail : metric.tails) {
      if (!std::isfinite(tail.difference)) continue;
      ++reached;
      ExpectHolds(tail.interval, tail.difference, metric.metric + ", " + tail.name);
    }
    EXPECT_GT(reached, 0u) << metric.metric;
    // Each value moved by more than its spread, so that 80 flights show it, and the bad side is that of the
    // metric.
    const bool rose = GetParam().moved > 0.0;
    EXPECT_EQ(metric.finding, metric.info.worse == Worse::kNeither             ? "differs"
                              : (metric.info.worse == Worse::kSmaller) == rose ? "better"
                                                                               : "worse")
        << metric.metric;
  }
}

TEST_P(ComparisonOfEveryMetric, TurnsRoundWhenItsSidesAreSwapped) {
  CaseColumns a = Flights(0.0, "a"), b = Flights(GetParam().moved, GetParam().draws_of_b);
  b.outcome[3] = Outcome::kLostControl;
  const Comparison forth = CompareAll(a, b), back = CompareAll(b, a);
  for (std::size_t i = 0; i < forth.metrics.size(); ++i) {
    const MetricComparison &one = forth.metrics[i], &other = back.metrics[i];
    EXPECT_EQ(one.difference, -other.difference) << one.metric;
    // The roots of unpaired limits round.
    EXPECT_NEAR(one.interval.lower, -other.interval.upper, 1e-12) << one.metric;
    EXPECT_NEAR(one.interval.upper, -other.interval.lower, 1e-12) << one.metric;
    EXPECT_EQ(one.a_better, other.b_better) << one.metric;
    EXPECT_EQ(one.gains.size(), other.losses.size()) << one.metric;
    EXPECT_NEAR(one.p, other.p, 1e-12) << one.metric;
    EXPECT_EQ(one.lost_b, 1u) << one.metric;
    EXPECT_EQ(other.lost_a, 1u) << one.metric;
  }
  EXPECT_EQ(forth.a.completed, kCases);
  EXPECT_EQ(forth.b.completed, kCases - 1);
  EXPECT_EQ(forth.b.flown, kCases);
}

INSTANTIATE_TEST_SUITE_P(Each, ComparisonOfEveryMetric,
                         testing::Values(Sides{"PairedUp", "a", 3.0}, Sides{"PairedDown", "a", -3.0},
                                         Sides{"UnpairedUp", "b", 3.0}, Sides{"UnpairedDown", "b", -3.0}),
                         [](const auto& sides) { return std::string(sides.param.name); });

// Holm: the least of m p-values counts m times. Each percentile is a family over the metrics, as the medians
// are.
TEST_P(ComparisonOfEveryMetric, AdjustsEachPercentileOverTheMetrics) {
  const CaseColumns a = Flights(0.0, "a"), b = Flights(0.01 * GetParam().moved, GetParam().draws_of_b);
  const Comparison comparison = CompareAll(a, b);
  std::map<std::string, std::vector<std::pair<double, double>>> families;
  for (const MetricComparison& metric : comparison.metrics) {
    families["median"].emplace_back(metric.p, metric.p_holm);
    for (const PercentileComparison& tail : metric.tails)
      if (!std::isnan(tail.p)) families[tail.name].emplace_back(tail.p, tail.p_holm);
  }
  EXPECT_EQ(families.size(), 3u) << "80 flights reach 5 and 95 %, and not 1 and 99 %";
  for (const auto& [name, family] : families) {
    const auto least = *std::min_element(family.begin(), family.end());
    EXPECT_DOUBLE_EQ(least.second, std::min(1.0, static_cast<double>(family.size()) * least.first)) << name;
    for (const auto& [p, adjusted] : family) EXPECT_GE(adjusted, p) << name;
  }
}

// If neither sample reaches a percentile, there is nothing to test.
TEST_P(ComparisonOfEveryMetric, DoesNotTestWhatNoSampleReaches) {
  const Comparison comparison =
      CompareAll(Flights(0.0, "a"), Flights(GetParam().moved, GetParam().draws_of_b));
  std::size_t unreached = 0;
  for (const MetricComparison& metric : comparison.metrics) {
    for (const PercentileComparison& tail : metric.tails) {
      if (std::isfinite(tail.a) || std::isfinite(tail.b)) {
        EXPECT_GE(tail.p, 0.0) << metric.metric << ", " << tail.name;
        continue;
      }
      ++unreached;
      EXPECT_TRUE(std::isnan(tail.p)) << metric.metric << ", " << tail.name;
      EXPECT_TRUE(std::isnan(tail.p_holm)) << metric.metric << ", " << tail.name;
    }
  }
  EXPECT_GT(unreached, comparison.metrics.size());
}

Requirement Below(double limit) {
  Requirement requirement;
  requirement.metric = "pitch_error_rms_deg";
  requirement.below = limit;
  return requirement;
}

// Five flights fail only in A, five only in B, ten in neither: the failures exclude each other, with a
// correlation of (0 * 10 - 5 * 5) / (5 * 15) = -1/3. The limits are sides of triangles with that angle.
TEST(ComparedRequirements, FailuresThatExcludeEachOtherWidenTheLimits) {
  std::vector<std::uint64_t> index;
  std::vector<double> input, a, b;
  for (std::uint64_t k = 0; k < 20; ++k) {
    index.push_back(k);
    input.push_back(0.1 * static_cast<double>(k));
    a.push_back(k < 5 ? 2.0 : 0.0);
    b.push_back(k >= 5 && k < 10 ? 2.0 : 0.0);
  }
  const RequirementComparison compared =
      CompareColumns(Columns(index, input, a), Columns(index, input, b), {Below(1.0)}).requirements.at(0);
  EXPECT_EQ(compared.difference, 0.0);
  const Interval rate = ClopperPearson(5, 20, kComparisonConfidence);
  const double down = 0.25 - rate.lower, up = rate.upper - 0.25;
  const double reach = std::sqrt(down * down + up * up + 2.0 / 3.0 * down * up);
  EXPECT_NEAR(compared.interval.lower, -reach, 1e-12);
  EXPECT_NEAR(compared.interval.upper, reach, 1e-12);
}

// Tea tasting: 3 of 4 fail in A, 1 of 4 in B; Fisher's tables as likely or less are 34 of 70.
TEST(ComparedRequirements, OfUnpairedCampaignsAreFishersTable) {
  const RequirementComparison compared =
      CompareColumns(Columns({0, 1, 2, 3}, {0.1, 0.2, 0.3, 0.4}, {2, 2, 2, 0}),
                     Columns({0, 1, 2, 3}, {0.5, 0.6, 0.7, 0.8}, {0, 0, 0, 2}), {Below(1.0)})
          .requirements.at(0);
  EXPECT_EQ(compared.difference, 0.25 - 0.75);
  EXPECT_NEAR(compared.p, 34.0 / 70.0, 1e-12);
  ExpectHolds(compared.interval, compared.difference, "failure rates");
}

}  // namespace
}  // namespace dispersa::analysis_comparison_intervals_test
