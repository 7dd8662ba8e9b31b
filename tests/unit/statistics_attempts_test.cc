// What several campaigns of one design show together: each rule by hand, and error rates by simulation.
#include "core/statistics/attempts.h"

#include "core/statistics/anytime.h"
#include "core/statistics/order_statistics.h"
#include "tests/test.h"

namespace dispersa::statistics_attempts_test {

constexpr double kShare = 0.95;
constexpr double kRisk = 0.10;

/// A campaign that ended as it was planned, judged by its own plan of one look.
Attempt Ended(std::uint64_t seed, std::int64_t cases, std::int64_t failures) {
  const auto most = MaxFailures(kShare, kRisk, cases);
  return {seed, cases, cases, failures, {}, most.has_value() && failures <= *most};
}

AttemptsVerdict Judged(const std::vector<Attempt>& attempts, std::uint64_t reserved = 1) {
  return JudgeAttempts(kShare, kRisk, reserved, attempts);
}

TEST(Attempts, TheFirstKeepsItsPlan) {
  const AttemptsVerdict verdict = Judged({Ended(1, 45, 0)});
  EXPECT_TRUE(verdict.passed);
  EXPECT_TRUE(verdict.by_plan);
  EXPECT_FALSE(verdict.is_spent);
  EXPECT_NEAR(verdict.risk_left, kRisk - std::pow(kShare, 45), 1e-12);
}

TEST(Attempts, AnotherSeedAddsToThePoolAndHasNoPlan) {
  // 1 failure of 45, then 0 of 45 with another seed: alone the second one passes.
  const AttemptsVerdict verdict = Judged({Ended(1, 45, 1), Ended(2, 45, 0)});
  EXPECT_FALSE(verdict.passed);
  EXPECT_TRUE(verdict.is_spent);
  EXPECT_EQ(verdict.pool_cases, 90);
  EXPECT_EQ(verdict.pool_failures, 1);
  ASSERT_TRUE(verdict.pool_needed.has_value());
  const double left = kRisk - std::pow(kShare, 45);
  EXPECT_EQ(*verdict.pool_needed, AnytimeCasesNeeded(kShare, left, 1));
  // With so many the pool passes, and with one less it does not.
  EXPECT_TRUE(Judged({Ended(1, 45, 1), Ended(2, *verdict.pool_needed - 45, 0)}).passed);
  EXPECT_FALSE(Judged({Ended(1, 45, 1), Ended(2, *verdict.pool_needed - 46, 0)}).passed);
}

/// Of a design that just misses, by a plan of one look.
double PassRiskOf(std::int64_t cases) {
  const std::int64_t most = MaxFailures(kShare, kRisk, cases).value();
  double risk = 0.0, term = std::pow(kShare, cases);
  for (std::int64_t k = 0; k <= most; ++k) {
    risk += term;
    term *= static_cast<double>(cases - k) / static_cast<double>(k + 1) * (1.0 - kShare) / kShare;
  }
  return risk;
}

Attempt OfAnotherEngine(Attempt attempt) {
  attempt.is_evidence = false;
  return attempt;
}

TEST(Attempts, OfAnotherEngineSpendRiskAndShowNothing) {
  // It passed and it spent the plan: two flights of this engine show what two flights show.
  const AttemptsVerdict after = Judged({OfAnotherEngine(Ended(1, 100, 0)), Ended(2, 2, 0)});
  EXPECT_FALSE(after.passed);
  EXPECT_FALSE(after.passed_before);
  EXPECT_TRUE(after.is_spent);
  EXPECT_EQ(after.pool_cases, 2);
  EXPECT_NEAR(after.risk_left, kRisk - PassRiskOf(100), 1e-12);
  // The same cases flown again by this engine, beside another seed of the other one: these alone are the
  // pool.
  const AttemptsVerdict again =
      Judged({OfAnotherEngine(Ended(8, 5, 0)), OfAnotherEngine(Ended(7, 5, 1)), Ended(7, 200, 0)});
  EXPECT_EQ(again.pool_cases, 200);
  EXPECT_EQ(again.pool_failures, 0);
  EXPECT_TRUE(again.passed);
}

TEST(Attempts, ThatCouldNotHavePassedSpendNothing) {
  const AttemptsVerdict verdict = Judged({Ended(1, 20, 0), Ended(2, 44, 3), Ended(3, 45, 0)});
  EXPECT_TRUE(verdict.passed);
  EXPECT_TRUE(verdict.by_plan);
  EXPECT_FALSE(verdict.is_spent);
}

TEST(Attempts, CasesThatWereSeenHaveNoPlan) {
  // 44 cases cannot pass. With one case more they would, if their number had not been chosen after a look.
  const AttemptsVerdict extended = Judged({Ended(1, 44, 0), Ended(1, 45, 0)});
  EXPECT_FALSE(extended.passed);
  EXPECT_FALSE(extended.is_spent);
  const std::int64_t needed = AnytimeCasesNeeded(kShare, kRisk, 0);
  EXPECT_EQ(extended.pool_needed, needed);
  EXPECT_FALSE(Judged({Ended(1, 44, 0), Ended(1, needed - 1, 0)}).passed);
  EXPECT_TRUE(Judged({Ended(1, 44, 0), Ended(1, needed, 0)}).passed);
  // The smallest number that passes, read off a chart of more cases of the same seed.
  const AttemptsVerdict fewer = Judged({Ended(1, 400, 30), Ended(1, 45, 0)});
  EXPECT_FALSE(fewer.passed);
  EXPECT_TRUE(fewer.is_spent);
  EXPECT_EQ(fewer.pool_cases, 400);
  EXPECT_EQ(fewer.pool_failures, 30);
}

TEST(Attempts, ACancelledOneHasSpentItsPlan) {
  // Cancelled after 30 of 45 cases, two of them without a result.
  const Attempt cancelled = {1, 45, 30, 3, {}, false};
  EXPECT_TRUE(Judged({cancelled, Ended(2, 45, 0)}).is_spent);
  EXPECT_FALSE(Judged({cancelled, Ended(2, 45, 0)}).passed);
  // Killed before anything was noted: its plan is spent all the same.
  EXPECT_TRUE(Judged({{1, 45, 0, 0, {}, false}, Ended(2, 45, 0)}).is_spent);
}

TEST(Attempts, ThatPassedStayPassed) {
  EXPECT_TRUE(Judged({Ended(1, 45, 0), Ended(1, 60, 1)}).passed) << "extended";
  const AttemptsVerdict other = Judged({Ended(1, 45, 0), Ended(2, 45, 0)});
  EXPECT_TRUE(other.passed_before);
}

TEST(Attempts, ReservedOnesShareTheRisk) {
  // 45 cases need 10 %; each of two attempts has 5 %, for which 59 are needed.
  EXPECT_FALSE(Judged({{1, 45, 45, 0, {}, false}}, 2).by_plan);
  const std::int64_t needed = CasesNeeded(kShare, kRisk / 2, 0);
  EXPECT_EQ(needed, 59);
  const Attempt first = {1, needed, needed, 1, {}, false}, second = {2, needed, needed, 0, {}, true};
  const AttemptsVerdict verdict = Judged({first, second}, 2);
  EXPECT_TRUE(verdict.passed);
  EXPECT_TRUE(verdict.by_plan);
  const Attempt missed = {2, needed, needed, 1, {}, false};
  EXPECT_FALSE(Judged({first, missed, {3, needed, needed, 0, {}, true}}, 2).by_plan);
  EXPECT_TRUE(Judged({first, first, {3, needed, needed, 0, {}, true}}, 2).by_plan) << "one attempt, twice";
}

TEST(Attempts, AnAnytimePlanGoesOnInThePool) {
  const VerdictPlan anytime{PlanKind::kAnytime, 1, Spending::kOBrienFleming};
  const std::int64_t needed = AnytimeCasesNeeded(kShare, kRisk, 1);
  const Attempt first = {1, 100, 70, 1, anytime, false};
  EXPECT_TRUE(Judged({first, {2, needed - 70, needed - 70, 0, anytime, false}}).passed);
  EXPECT_FALSE(Judged({first, {2, needed - 71, needed - 71, 0, anytime, false}}).passed);
}

/// MaxFailures of the requirement, computed once for each number of cases.
std::optional<std::int64_t> MostFailures(std::int64_t cases) {
  static std::map<std::int64_t, std::optional<std::int64_t>> known;
  const auto [at, is_new] = known.try_emplace(cases);
  if (is_new) at->second = MaxFailures(kShare, kRisk, cases);
  return at->second;
}

/// How often somebody passes a design that just misses (it fails with 5 %) at any of his attempts.
class Somebody {
 public:
  explicit Somebody(std::uint64_t seed) : random_(seed) {}

  /// Failures among the first n cases of a seed: the same every time they are flown.
  std::int64_t Failures(std::uint64_t seed, std::int64_t n) {
    std::vector<std::int64_t>& counts = flown_[seed % flown_.size()];
    while (std::ssize(counts) <= n) {
      const std::int64_t before = counts.empty() ? 0 : counts.back();
      counts.push_back(
          counts.empty() ? 0 : before + (std::bernoulli_distribution(1.0 - kShare)(random_) ? 1 : 0));
    }
    return counts[static_cast<std::size_t>(n)];
  }
  /// A campaign; whether its verdict, alone and with the ledger, is a pass.
  void Fly(std::uint64_t seed, std::int64_t planned, std::int64_t cases) {
    const std::int64_t failures = Failures(seed, cases);
    const auto most = MostFailures(planned);
    const bool alone = cases == planned && most && failures <= *most;
    attempts_.push_back({seed, planned, cases, failures, {}, alone});
    const AttemptsVerdict verdict = Judged(attempts_);
    alone_ = alone_ || alone;
    stands_ = stands_ || (alone && (verdict.passed || verdict.passed_before)) || verdict.passed;
  }
  bool alone() const { return alone_; }
  bool stands() const { return stands_; }

 private:
  std::mt19937_64 random_;
  std::vector<std::vector<std::int64_t>> flown_ = std::vector<std::vector<std::int64_t>>(64);
  std::vector<Attempt> attempts_;
  bool alone_ = false;
  bool stands_ = false;
};

struct Rates {
  double alone = 0.0;
  double stands = 0.0;
};

Rates RatesOf(int people, const std::function<void(Somebody&)>& misuse) {
  Rates rates;
  for (int i = 0; i < people; ++i) {
    Somebody somebody(static_cast<std::uint64_t>(1000 + i));
    misuse(somebody);
    rates.alone += somebody.alone() ? 1.0 : 0.0;
    rates.stands += somebody.stands() ? 1.0 : 0.0;
  }
  rates.alone /= people;
  rates.stands /= people;
  return rates;
}

int People() {
  const char* many = std::getenv("DISPERSA_ATTEMPTS");
  return many == nullptr ? 400 : std::atoi(many);
}

/// Without the ledger it is a misuse; with it at most the stated risk, and four standard errors of this many.
void ExpectHeld(const Rates& rates, double misused) {
  const double error = std::sqrt(kRisk * (1.0 - kRisk) / People());
  EXPECT_GT(rates.alone, misused);
  EXPECT_LE(rates.stands, kRisk + 4.0 * error);
  std::printf("alone %.3f, with the ledger %.3f\n", rates.alone, rates.stands);
}

TEST(AttemptsMisused, SeedsUntilOnePasses) {
  for (const auto& [seeds, misused] : {std::pair{5, 0.35}, {10, 0.55}, {20, 0.8}}) {
    ExpectHeld(RatesOf(People(),
                       [seeds = seeds](Somebody& somebody) {
                         for (int seed = 0; seed < seeds && !somebody.stands(); ++seed)
                           somebody.Fly(static_cast<std::uint64_t>(seed), 45, 45);
                       }),
               misused);
  }
}

TEST(AttemptsMisused, TheSmallestNumberOfCasesThatPasses) {
  ExpectHeld(RatesOf(People(),
                     [](Somebody& somebody) {
                       somebody.Fly(1, 400, 400);
                       for (std::int64_t n = 45; n < 400; ++n)
                         if (const auto most = MostFailures(n); most && somebody.Failures(1, n) <= *most)
                           return somebody.Fly(1, n, n);
                     }),
             0.2);
}

TEST(AttemptsMisused, CancelledAtTheFirstFailureAndLaunchedAgain) {
  ExpectHeld(RatesOf(People(),
                     [](Somebody& somebody) {
                       for (std::uint64_t seed = 0; seed < 20 && !somebody.stands(); ++seed) {
                         std::int64_t cases = 1;
                         while (cases < 45 && somebody.Failures(seed, cases) == 0) ++cases;
                         somebody.Fly(seed, 45, cases);
                       }
                     }),
             0.8);
}

TEST(AttemptsMisused, TooFewCasesFirstAndMoreOfWhatLooksWell) {
  ExpectHeld(RatesOf(People(),
                     [](Somebody& somebody) {
                       for (std::uint64_t seed = 0; seed < 20 && !somebody.stands(); ++seed) {
                         somebody.Fly(seed, 44, 44);
                         if (somebody.Failures(seed, 44) == 0) somebody.Fly(seed, 45, 45);
                       }
                     }),
             0.7);
}

TEST(AttemptsMisused, ExtendedUntilItPasses) {
  ExpectHeld(RatesOf(People(),
                     [](Somebody& somebody) {
                       for (std::int64_t n = 45; n <= 600 && !somebody.stands(); n += 15)
                         somebody.Fly(1, n, n);
                     }),
             0.2);
}

}  // namespace dispersa::statistics_attempts_test
