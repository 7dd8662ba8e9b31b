// Every verdict, interval and bound, 20,000 times on made-up campaigns: how often it errs against how often it
// says it may. Prints the table of core/statistics/README.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/random/draws.h"
#include "core/random/latin_hypercube.h"
#include "core/statistics/anytime.h"
#include "core/statistics/intervals.h"
#include "core/statistics/order_statistics.h"
#include "core/statistics/paired.h"
#include "core/statistics/percentiles.h"
#include "core/statistics/planned_verdict.h"
#include "core/statistics/replicates.h"
#include "core/statistics/sensitivity.h"

namespace dispersa {
namespace {

constexpr int kRepetitions = 20000;
constexpr double kProbability = 0.97;
constexpr double kRisk = 0.10;

/// Cases whose failure probability is exactly what a requirement of `kProbability` allows.
class Flights {
 public:
  explicit Flights(int repetition) : random_(static_cast<std::uint64_t>(repetition) + 1) {}

  CaseTally& Upto(std::int64_t n) {
    std::uniform_real_distribution<double> uniform;
    for (; n_ < n; ++n_) {
      if (uniform(random_) >= kProbability) tally_.failed.push_back(n_);
    }
    return tally_;
  }

 private:
  std::mt19937_64 random_;
  std::int64_t n_ = 0;
  CaseTally tally_;
};

/// Share of the repetitions in which something happens.
double Share(const std::function<bool(int)>& happens) {
  int count = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) count += happens(repetition);
  return count / double{kRepetitions};
}

/// `rate` must not exceed what is stated by more than four standard errors.
void Row(const std::string& what, double rate, double stated) {
  std::printf("| %s | %.4f | %.4f |\n", what.c_str(), rate, stated);
  std::fflush(stdout);
  EXPECT_LE(rate, stated + 4.0 * std::sqrt(stated * (1.0 - stated) / kRepetitions)) << what;
  EXPECT_GT(rate, 0.0) << what << ": a simulation in which nothing ever errs shows nothing";
}

TEST(Coverage, OfOneLook) {
  const PlannedRequirement planned = {kProbability, kRisk, {}, 400};
  const auto verdict = [&](int k) { return Decide(planned, 400, Flights(k).Upto(400)).verdict; };
  Row("one look at 400: false PASS", Share([&](int k) { return verdict(k) == Verdict::kPass; }), kRisk);
  Row("one look at 400: false FAIL", Share([&](int k) { return verdict(k) == Verdict::kFail; }), kRisk);
}

TEST(Coverage, OfGroupSequentialPlans) {
  for (const Spending spending : {Spending::kOBrienFleming, Spending::kPocock}) {
    const std::string name = spending == Spending::kPocock ? "Pocock" : "O'Brien-Fleming";
    // The boundaries as Decide() takes them; whoever looks stops at the first decision, or never.
    const auto looks = Boundaries({PlanKind::kGroupSequential, 5, spending}, kProbability, kRisk, 400);
    const auto ever = [&](int k, bool pass) {
      Flights flights(k);
      return std::any_of(looks.begin(), looks.end(), [&](const LookBoundary& look) {
        const std::int64_t failures = flights.Upto(look.n).Failed(look.n);
        return pass ? failures <= look.accept : failures >= look.reject;
      });
    };
    Row("five looks to 400, " + name + ": false PASS", Share([&](int k) { return ever(k, true); }), kRisk);
    Row("five looks to 400, " + name + ": false FAIL", Share([&](int k) { return ever(k, false); }), kRisk);
  }
}

TEST(Coverage, OfAnytimePlans) {
  constexpr std::int64_t kLast = 2000;
  std::vector<LookBoundary> looks;
  for (std::int64_t n = 1; n <= kLast; ++n) looks.push_back(AnytimeBoundary(kProbability, kRisk, kRisk, n));
  const auto ever = [&](int k, bool pass) {
    Flights flights(k);
    const CaseTally& tally = flights.Upto(kLast);
    std::size_t next = 0;
    for (const LookBoundary& look : looks) {
      while (next < tally.failed.size() && tally.failed[next] < look.n) ++next;
      const auto failures = static_cast<std::int64_t>(next);
      if (pass ? failures <= look.accept : failures >= look.reject) return true;
    }
    return false;
  };
  Row("anytime, read after each of 2000 cases: false PASS", Share([&](int k) { return ever(k, true); }), kRisk);
  Row("anytime, read after each of 2000 cases: false FAIL", Share([&](int k) { return ever(k, false); }), kRisk);
}

/// The misuse: fly, read, follow "cases needed", until it passes or 1000 cases are flown.
TEST(Coverage, OfLookingUntilItPasses) {
  const std::int64_t first = CasesNeeded(kProbability, kRisk, 0);
  const auto naive = [&](int k) {
    Flights flights(k);
    for (std::int64_t n = first; n <= 1000;) {
      const std::int64_t failures = flights.Upto(n).Failed(n);
      if (ConsumerRisk(kProbability, n, failures) <= kRisk) return true;
      n = CasesNeeded(kProbability, kRisk, failures);
    }
    return false;
  };
  const double without = Share(naive);
  std::printf("| looking until it passes, without a plan | %.4f | %.4f |\n", without, kRisk);
  EXPECT_GT(without, 0.2);
  const PlannedRequirement planned = {kProbability, kRisk, {}, first};
  const auto with_plan = [&](int k) {
    Flights flights(k);
    // Each look is asked in its turn, so none needs to be told of those before it.
    for (std::int64_t n = first; n <= 1000;) {
      const CaseTally& tally = flights.Upto(n);
      if (Decide(planned, n, tally).verdict == Verdict::kPass) return true;
      n = std::max(n + n / 8, CasesNeeded(kProbability, kRisk, tally.Failed(n)));
    }
    return false;
  };
  Row("looking until it passes, with the plan of the first look", Share(with_plan), kRisk);
}

TEST(Coverage, OfBoundsOfAProbability) {
  for (const std::int64_t n : {50, 400}) {
    const std::string name = "Clopper-Pearson of " + std::to_string(n) + ": ";
    const auto failures = [n](int k) { return Flights(k).Upto(n).Failed(n); };
    Row(name + "lower above the truth",
        Share([&](int k) { return ClopperPearsonLower(n - failures(k), n, 1.0 - kRisk) > kProbability; }), kRisk);
    Row(name + "upper below the truth",
        Share([&](int k) { return ClopperPearsonUpper(n - failures(k), n, 1.0 - kRisk) < kProbability; }), kRisk);
  }
  // A confidence sequence, read where it looks worst: at any of these counts.
  const auto outside = [](int k, bool lower) {
    Flights flights(k);
    for (const std::int64_t n : {50, 100, 200, 400, 800}) {
      const std::int64_t failures = flights.Upto(n).Failed(n);
      const LookBoundary at_truth = AnytimeBoundary(kProbability, kRisk, kRisk, n);
      if (lower ? failures <= at_truth.accept : failures >= at_truth.reject) return true;
    }
    return false;
  };
  Row("confidence sequence to 800: lower ever above the truth", Share([&](int k) { return outside(k, true); }),
      kRisk);
  Row("confidence sequence to 800: upper ever below the truth", Share([&](int k) { return outside(k, false); }),
      kRisk);
}

/// Exponential values: skewed as peaks are; the quantile is -ln(1 - p).
std::vector<double> SortedExponential(int repetition, std::size_t n) {
  std::mt19937_64 random(static_cast<std::uint64_t>(repetition) + 7);
  std::exponential_distribution<double> exponential;
  std::vector<double> values(n);
  for (double& value : values) value = exponential(random);
  std::sort(values.begin(), values.end());
  return values;
}

TEST(Coverage, OfPercentiles) {
  for (const double probability : {0.05, 0.5, 0.95, 0.99}) {
    const double truth = -std::log1p(-probability);
    char name[80];
    std::snprintf(name, sizeof name, "limits of the %g %% of 200 values: the truth outside", 100.0 * probability);
    Row(name, Share([&](int k) {
          const Interval limits = QuantileInterval(SortedExponential(k, 200), probability, kPercentileConfidence);
          return truth < limits.lower || truth > limits.upper;
        }),
        1.0 - kPercentileConfidence);
  }
  // The bound beside a verdict: with c failures allowed, the (c + 1)-th largest.
  const double truth = -std::log1p(-0.95);
  const std::int64_t allowed = MaxFailures(0.95, kRisk, 200).value();
  Row("order-statistic bound at (95 %, 10 %) of 200 values: below the truth", Share([&](int k) {
        return SortedExponential(k, 200)[static_cast<std::size_t>(199 - allowed)] < truth;
      }),
      kRisk);
}

/// Failures of a Latin hypercube in two inputs: the corner u + v > limit, whose probability is (2 - limit)^2 / 2.
std::vector<double> ReplicateShares(int repetition, std::uint64_t replicates, std::uint64_t points, double limit) {
  std::vector<double> shares;
  for (std::uint64_t r = 0; r < replicates; ++r) {
    const LatinHypercube design(static_cast<std::uint64_t>(repetition) * replicates + r, points, {"u", "v"});
    double failures = 0.0;
    for (std::uint64_t k = 0; k < points; ++k) failures += design.Uniform(k, 0) + design.Uniform(k, 1) > limit;
    shares.push_back(failures / static_cast<double>(points));
  }
  return shares;
}

TEST(Coverage, OfReplicates) {
  // Student's t over few replicates is approximate; README.md says by how much, and these numbers hold it to that.
  const struct {
    std::uint64_t replicates, points;
    double failing, stated_upper;
  } cases[] = {{10, 50, 0.1, 0.12}, {20, 50, 0.03, 0.12}, {20, 20, 0.01, 0.20}};
  for (const auto& [replicates, points, failing, stated_upper] : cases) {
    const double limit = 2.0 - std::sqrt(2.0 * failing);
    char name[100];
    std::snprintf(name, sizeof name, "%d Latin hypercubes of %d, %g %% failing: ", static_cast<int>(replicates),
                  static_cast<int>(points), 100.0 * failing);
    Row(std::string(name) + "upper below the truth", Share([&](int k) {
          return ReplicateMeanBounds(ReplicateShares(k, replicates, points, limit), kRisk).upper < failing;
        }),
        stated_upper);
    Row(std::string(name) + "lower above the truth", Share([&](int k) {
          return ReplicateMeanBounds(ReplicateShares(k, replicates, points, limit), kRisk).lower > failing;
        }),
        kRisk);
  }
}

TEST(Coverage, OfComparisonsAndIndices) {
  Row("median difference of 101 pairs: the truth outside", Share([](int k) {
        std::mt19937_64 random(static_cast<std::uint64_t>(k));
        std::normal_distribution<double> normal;
        std::vector<double> a(101), b(101);
        for (std::size_t i = 0; i < a.size(); ++i) {
          a[i] = normal(random);
          b[i] = a[i] + 0.5 + normal(random);
        }
        const Interval interval = ComparePaired(a, b, 0.95).difference_interval;
        return interval.lower > 0.5 || interval.upper < 0.5;
      }),
      0.05);
  // y = x + noise: 0.5. The classes smooth a little away and the bootstrap knows nothing of that.
  Row("first-order index of 400 cases: the truth outside", Share([](int k) {
        std::mt19937_64 random(static_cast<std::uint64_t>(k));
        std::normal_distribution<double> normal;
        std::vector<double> x(400), y(400);
        for (std::size_t i = 0; i < x.size(); ++i) {
          x[i] = normal(random);
          y[i] = x[i] + normal(random);
        }
        const SensitivityIndex index = FirstOrderIndex(x, y, static_cast<std::uint64_t>(k));
        return index.low > 0.5 || index.high < 0.5;
      }),
      0.08);
}

}  // namespace
}  // namespace dispersa
