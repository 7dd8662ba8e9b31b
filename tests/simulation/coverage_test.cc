// Every verdict, interval and bound, 20,000 times on made-up campaigns: the simulated rate of errors against
// the stated one. Prints the table of tests/data/stats/error_rates.txt, and compares that table with it.
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>

#include "core/random/draws.h"
#include "core/random/latin_hypercube.h"
#include "core/random/sobol.h"
#include "core/statistics/anytime.h"
#include "core/statistics/intervals.h"
#include "core/statistics/order_statistics.h"
#include "core/statistics/paired.h"
#include "core/statistics/percentiles.h"
#include "core/statistics/planned_verdict.h"
#include "core/statistics/replicates.h"
#include "core/statistics/sensitivity.h"
#include "core/statistics/two_samples.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::coverage_test {
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

/// A rate of the table in tests/data/stats/error_rates.txt, which must hold the line as it comes out here.
/// Standard errors are those of the repetitions; that any of fifty true lines is four of them off has less
/// than 0.4 %.
class Row {
 public:
  Row(std::string what, double rate) : what_(std::move(what)), rate_(rate) {}

  /// The rate is known, by enumeration here, and keeps to what is stated.
  void IsExactly(double exact, double stated) {
    Print(Text("%.4f", exact), stated);
    EXPECT_NEAR(rate_, exact, 4.0 * std::sqrt(exact * (1.0 - exact) / kRepetitions) + 1e-9) << what_;
    EXPECT_LE(exact, stated + 1e-12) << what_;
  }
  /// The stated bound is proved; the rate itself is not known.
  void IsAtMost(double stated) {
    Print("", stated);
    EXPECT_LE(rate_, stated + 4.0 * std::sqrt(stated * (1.0 - stated) / kRepetitions)) << what_;
    EXPECT_GT(rate_, 0.0) << what_ << ": a simulation in which nothing ever errs shows nothing";
  }
  /// An approximate method: its rate is `measured`, the number of an earlier simulation of as many
  /// repetitions.
  void IsAbout(double measured, double stated) {
    Print("approximate", stated);
    EXPECT_NEAR(rate_, measured, 4.0 * std::sqrt(2.0 * measured * (1.0 - measured) / kRepetitions)) << what_;
  }
  /// A misuse, whose rate is known.
  void Misuses(double exact, double stated) {
    Print(Text("%.4f", exact), stated);
    EXPECT_NEAR(rate_, exact, 4.0 * std::sqrt(exact * (1.0 - exact) / kRepetitions)) << what_;
    EXPECT_GT(exact, stated);
  }

 private:
  static std::string Text(const char* format, double value) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
  }

  void Print(const std::string& known, double stated) const {
    const std::string line =
        "| " + what_ + " | " + Text("%.4f", rate_) + " | " + known + " | " + Text("%.4g", stated) + " |";
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    static const std::string table = TextOfFile(DISPERSA_TEST_DATA "/stats/error_rates.txt");
    EXPECT_TRUE(table.find(line) != std::string::npos)
        << "tests/data/stats/error_rates.txt says otherwise than\n"
        << line;
  }

  std::string what_;
  double rate_;
};

using Counts = boost::math::binomial_distribution<double>;

/// Probability of k failures in n cases, of k or fewer; cases fail with what the requirement just allows.
double Mass(std::int64_t n, std::int64_t k, double failing = 1.0 - kProbability) {
  return k < 0 || k > n ? 0.0 : pdf(Counts(static_cast<double>(n), failing), static_cast<double>(k));
}
double Upto(std::int64_t n, std::int64_t k, double failing = 1.0 - kProbability) {
  return k < 0 ? 0.0 : k >= n ? 1.0 : cdf(Counts(static_cast<double>(n), failing), static_cast<double>(k));
}

/// Probability of ever meeting a condition on (look, failures), whatever the other boundary says: by
/// enumeration of the failures at each look.
double Ever(const std::vector<LookBoundary>& looks,
            const std::function<bool(const LookBoundary&, std::int64_t)>& condition) {
  std::vector<double> open = {1.0};  // by failures so far, of those that have not met it
  double met = 0.0;
  std::int64_t n = 0;
  for (const LookBoundary& look : looks) {
    const std::int64_t step = look.n - n;
    n = look.n;
    std::vector<double> next(open.size() + static_cast<std::size_t>(step), 0.0);
    for (std::size_t before = 0; before < open.size(); ++before) {
      if (open[before] < 1e-18) continue;
      for (std::int64_t more = 0; more <= step; ++more)
        next[before + static_cast<std::size_t>(more)] += open[before] * Mass(step, more);
    }
    for (std::size_t failures = 0; failures < next.size(); ++failures) {
      if (!condition(look, static_cast<std::int64_t>(failures))) continue;
      met += next[failures];
      next[failures] = 0.0;
    }
    while (next.size() > 1 && next.back() < 1e-18) next.pop_back();
    open = std::move(next);
  }
  return met;
}
double EverPasses(const std::vector<LookBoundary>& looks) {
  return Ever(looks, [](const LookBoundary& look, std::int64_t failures) { return failures <= look.accept; });
}
double EverFails(const std::vector<LookBoundary>& looks) {
  return Ever(looks, [](const LookBoundary& look, std::int64_t failures) { return failures >= look.reject; });
}

/// Probability that following "cases needed" from `first` on passes before more than `last` cases are flown.
double PassesInTheEnd(std::int64_t first, std::int64_t last) {
  std::map<std::int64_t, std::map<std::int64_t, double>> looks;  // by cases and failures
  for (std::int64_t k = 0; k <= first; ++k) looks[first][k] = Mass(first, k);
  double passed = 0.0;
  while (!looks.empty()) {
    const auto [n, states] = *looks.begin();
    looks.erase(looks.begin());
    for (const auto& [failures, probability] : states) {
      if (ConsumerRisk(kProbability, n, failures) <= kRisk) {
        passed += probability;
        continue;
      }
      const std::int64_t next = CasesNeeded(kProbability, kRisk, failures);
      if (next > last || probability < 1e-15) continue;
      for (std::int64_t more = 0; more <= next - n; ++more)
        looks[next][failures + more] += probability * Mass(next - n, more);
    }
  }
  return passed;
}

TEST(Coverage, OfOneLook) {
  const PlannedRequirement planned = {kProbability, kRisk, {}, 400};
  const auto verdict = [&](int k) { return Decide(planned, 400, Flights(k).Upto(400)).verdict; };
  const std::int64_t accept = MaxFailures(kProbability, kRisk, 400).value();
  std::int64_t reject = 400;
  while (1.0 - Upto(400, reject - 2) <= kRisk) --reject;
  Row("one look at 400: false PASS", Share([&](int k) { return verdict(k) == Verdict::kPass; }))
      .IsExactly(Upto(400, accept), kRisk);
  Row("one look at 400: false FAIL", Share([&](int k) { return verdict(k) == Verdict::kFail; }))
      .IsExactly(1.0 - Upto(400, reject - 1), kRisk);
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
    Row("five looks to 400, " + name + ": false PASS", Share([&](int k) { return ever(k, true); }))
        .IsExactly(EverPasses(looks), kRisk);
    Row("five looks to 400, " + name + ": false FAIL", Share([&](int k) { return ever(k, false); }))
        .IsExactly(EverFails(looks), kRisk);
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
  Row("anytime, read after each of 2000 cases: false PASS", Share([&](int k) { return ever(k, true); }))
      .IsExactly(EverPasses(looks), kRisk);
  Row("anytime, read after each of 2000 cases: false FAIL", Share([&](int k) { return ever(k, false); }))
      .IsExactly(EverFails(looks), kRisk);
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
  Row("misuse: looking until it passes, without a plan, to 1000", Share(naive))
      .Misuses(PassesInTheEnd(first, 1000), kRisk);
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
  Row("the same, judged by the plan of the first look", Share(with_plan)).IsAtMost(kRisk);
}

TEST(Coverage, OfSeveralRequirements) {
  constexpr std::int64_t kCases = 400;
  constexpr int kRequirements = 3;
  const PlannedRequirement planned = {kProbability, kRisk, {}, kCases};
  const auto any_pass = [&](int k, bool holm) {
    std::vector<CaseTally> tallies;
    for (int i = 0; i < kRequirements; ++i) tallies.push_back(Flights(kRequirements * k + i).Upto(kCases));
    const auto verdicts = DecideAll({planned, planned, planned}, holm, kCases, tallies);
    return std::any_of(verdicts.begin(), verdicts.end(),
                       [](const PlannedVerdict& verdict) { return verdict.verdict == Verdict::kPass; });
  };
  // All are missed, so the first to pass does so at the risk that Holm gives it: its share.
  const auto of_one = [&](double risk) {
    const auto accept = MaxFailures(kProbability, risk, kCases);
    return accept ? Upto(kCases, *accept) : 0.0;
  };
  Row("three requirements, Holm: any false PASS", Share([&](int k) { return any_pass(k, true); }))
      .IsExactly(1.0 - std::pow(1.0 - of_one(kRisk / kRequirements), kRequirements), kRisk);
  Row("three requirements, each at its risk: any false PASS",
      Share([&](int k) { return any_pass(k, false); }))
      .IsExactly(1.0 - std::pow(1.0 - of_one(kRisk), kRequirements), kRequirements * kRisk);
}

TEST(Coverage, OfBoundsOfAProbability) {
  for (const std::int64_t n : {50, 400}) {
    const std::string name = "Clopper-Pearson of " + std::to_string(n) + ": ";
    const auto failures = [n](int k) { return Flights(k).Upto(n).Failed(n); };
    double low = 0.0, high = 0.0;
    for (std::int64_t k = 0; k <= n; ++k) {
      low += ClopperPearsonLower(n - k, n, 1.0 - kRisk) > kProbability ? Mass(n, k) : 0.0;
      high += ClopperPearsonUpper(n - k, n, 1.0 - kRisk) < kProbability ? Mass(n, k) : 0.0;
    }
    Row(name + "lower above the truth",
        Share([&](int k) { return ClopperPearsonLower(n - failures(k), n, 1.0 - kRisk) > kProbability; }))
        .IsExactly(low, kRisk);
    Row(name + "upper below the truth",
        Share([&](int k) { return ClopperPearsonUpper(n - failures(k), n, 1.0 - kRisk) < kProbability; }))
        .IsExactly(high, kRisk);
  }
  // The confidence sequence, read at any of these counts.
  std::vector<LookBoundary> looks;
  for (const std::int64_t n : {50, 100, 200, 400, 800}) looks.push_back({n, 0, 0});
  const auto lower_wrong = [](const LookBoundary& look, std::int64_t failures) {
    return AnytimeSuccess(look.n, failures, failures, kRisk).lower > kProbability;
  };
  const auto upper_wrong = [](const LookBoundary& look, std::int64_t failures) {
    return AnytimeSuccess(look.n, failures, failures, kRisk).upper < kProbability;
  };
  // Each bound is a search: it is asked once for each pair.
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<bool, bool>> asked;
  const auto wrong = [&](const LookBoundary& look, std::int64_t failures, bool lower) {
    const auto [at, is_new] = asked.try_emplace({look.n, failures});
    if (is_new) at->second = {lower_wrong(look, failures), upper_wrong(look, failures)};
    return lower ? at->second.first : at->second.second;
  };
  const auto ever = [&](int k, bool lower) {
    Flights flights(k);
    return std::any_of(looks.begin(), looks.end(), [&](const LookBoundary& look) {
      return wrong(look, flights.Upto(look.n).Failed(look.n), lower);
    });
  };
  for (const bool lower : {true, false}) {
    const double exact = Ever(looks, [&](const LookBoundary& look, std::int64_t failures) {
      return failures < 150 && wrong(look, failures, lower);  // more than 150 have less than 1e-20
    });
    Row(lower ? "confidence sequence to 800: lower ever above the truth"
              : "confidence sequence to 800: upper ever below the truth",
        Share([&](int k) { return ever(k, lower); }))
        .IsExactly(exact, kRisk);
  }
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
    std::snprintf(name, sizeof name, "limits of the %g %% of 200 values: the truth outside",
                  100.0 * probability);
    const RankInterval ranks = QuantileRanks(200, probability, kPercentileConfidence);
    // Values up to the truth are Binomial(200, probability); a rank beyond the sample gives no limit.
    const double below = ranks.lower >= 1 ? Upto(200, ranks.lower - 1, probability) : 0.0;
    const double above = ranks.upper <= 200 ? 1.0 - Upto(200, ranks.upper - 1, probability) : 0.0;
    Row(name, Share([&](int k) {
          const Interval limits =
              QuantileInterval(SortedExponential(k, 200), probability, kPercentileConfidence);
          return truth < limits.lower || truth > limits.upper;
        }))
        .IsExactly(below + above, 1.0 - kPercentileConfidence);
  }
  // The bound beside a verdict: with c failures allowed, the (c + 1)-th largest.
  const double truth = -std::log1p(-0.95);
  const std::int64_t allowed = MaxFailures(0.95, kRisk, 200).value();
  Row("order-statistic bound at (95 %, 10 %) of 200 values: below the truth", Share([&](int k) {
        return SortedExponential(k, 200)[static_cast<std::size_t>(199 - allowed)] < truth;
      }))
      .IsExactly(Upto(200, allowed, 0.05), kRisk);
  // Wilks' number of cases: the largest value exceeds the quantile but for the risk.
  const std::int64_t wilks = CasesNeeded(0.95, kRisk, 0);
  Row("largest of the " + std::to_string(wilks) + " values that Wilks asks for (95 %, 10 %): below the truth",
      Share([&](int k) { return SortedExponential(k, static_cast<std::size_t>(wilks)).back() < truth; }))
      .IsExactly(std::pow(0.95, static_cast<double>(wilks)), kRisk);
}

/// Failures of designs in two inputs: the corner u + v > limit, whose probability is (2 - limit)^2 / 2.
std::int64_t Failures(const auto& design, std::uint64_t points, double limit) {
  std::int64_t failures = 0;
  for (std::uint64_t k = 0; k < points; ++k) failures += design.Uniform(k, 0) + design.Uniform(k, 1) > limit;
  return failures;
}

TEST(Coverage, OfReplicates) {
  // By Student's t alone, upper bounds would be too low where failures are rare: 19.8 % of them for the 20
  // hypercubes of 20 points.
  const struct {
    bool sobol;
    std::uint64_t replicates, points;
    double failing;
  } cases[] = {{false, 10, 50, 0.1}, {false, 20, 50, 0.03}, {false, 20, 20, 0.01}, {true, 16, 64, 0.03}};
  for (const auto& [sobol, replicates, points, failing] : cases) {
    const double limit = 2.0 - std::sqrt(2.0 * failing);
    const auto bounds = [&](int repetition) {
      std::vector<std::int64_t> counts;
      for (std::uint64_t r = 0; r < replicates; ++r) {
        const std::uint64_t seed = static_cast<std::uint64_t>(repetition) * replicates + r;
        counts.push_back(sobol ? Failures(Sobol(seed, {"u", "v"}), points, limit)
                               : Failures(LatinHypercube(seed, points, {"u", "v"}), points, limit));
      }
      return ReplicateBounds(counts, static_cast<std::int64_t>(points), kRisk);
    };
    char name[100];
    std::snprintf(name, sizeof name, "%d %s of %d, %g %% failing: ", static_cast<int>(replicates),
                  sobol ? "Sobol designs" : "Latin hypercubes", static_cast<int>(points), 100.0 * failing);
    Row(std::string(name) + "upper below the truth", Share([&](int k) { return bounds(k).upper < failing; }))
        .IsAtMost(kRisk);
    Row(std::string(name) + "lower above the truth", Share([&](int k) { return bounds(k).lower > failing; }))
        .IsAtMost(kRisk);
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
      }))
      .IsExactly(Upto(101, QuantileRanks(101, 0.5, 0.95).lower - 1, 0.5) +
                     (1.0 - Upto(101, QuantileRanks(101, 0.5, 0.95).upper - 1, 0.5)),
                 0.05);
  // Skewed samples whose tails are the same, paired with a correlation of 0.81 (of the logarithms) and
  // independent.
  for (const auto& [n, probability] : {std::pair{200, 0.95}, std::pair{500, 0.99}}) {
    for (const bool paired : {true, false}) {
      int missed = 0, rejected = 0;
      for (int k = 0; k < kRepetitions; ++k) {
        std::mt19937_64 random(static_cast<std::uint64_t>(k));
        std::normal_distribution<double> normal;
        std::vector<double> a, b;
        for (int i = 0; i < n; ++i) {
          const double shared = paired ? 0.9 * normal(random) : 0.0;
          const double own = paired ? std::sqrt(1.0 - 0.81) : 1.0;
          a.push_back(std::exp(shared + own * normal(random)));
          b.push_back(std::exp(shared + own * normal(random)));
        }
        const QuantileDifference tail = CompareQuantiles(a, b, probability, 0.95, paired);
        missed += tail.interval.lower > 0.0 || tail.interval.upper < 0.0;
        rejected += tail.p <= 0.05;
      }
      const std::string what = std::to_string(n) + (paired ? " pairs, " : " cases each, ") +
                               std::to_string(std::lround(100.0 * probability)) + " %";
      Row(what + " quantiles: their difference outside", missed / double{kRepetitions}).IsAtMost(0.05);
      Row(what + " quantiles: equal tails told apart", rejected / double{kRepetitions}).IsAtMost(0.05);
    }
  }
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
      }))
      .IsAbout(0.0640, 0.05);
}

}  // namespace
}  // namespace dispersa::coverage_test
