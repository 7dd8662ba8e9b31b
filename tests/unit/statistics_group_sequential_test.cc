// Boundaries of several looks against the enumeration of every sequence of cases.
#include "core/statistics/group_sequential.h"

#include "core/statistics/order_statistics.h"
#include "tests/test.h"

namespace dispersa::statistics_group_sequential_test {

/// Probability, over all 2^n sequences of n cases, that some look decides.
template <typename Decides>
double Enumerated(double probability, const std::vector<LookBoundary>& looks, Decides decides) {
  const auto n = static_cast<int>(looks.back().n);
  double sum = 0.0;
  for (unsigned sequence = 0; sequence < 1u << n; ++sequence) {
    int failures = 0;
    std::size_t next = 0;
    bool decided = false;
    double weight = 1.0;
    for (int k = 0; k < n; ++k) {
      const bool fails = (sequence >> k & 1u) != 0;
      failures += fails;
      weight *= fails ? 1.0 - probability : probability;
      if (k + 1 != looks[next].n) continue;
      decided = decided || decides(looks[next], failures);
      ++next;
    }
    if (decided) sum += weight;
  }
  return sum;
}

TEST(GroupSequential, RisksAreThoseOfEverySequence) {
  const std::vector<LookBoundary> looks = {{4, 0, 3}, {9, 1, 5}, {14, 3, 6}};
  for (const double probability : {0.5, 0.8, 0.95}) {
    EXPECT_NEAR(PassRisk(probability, looks),
                Enumerated(probability, looks, [](const LookBoundary& l, int f) { return f <= l.accept; }),
                1e-13);
    EXPECT_NEAR(FailRisk(probability, looks),
                Enumerated(probability, looks, [](const LookBoundary& l, int f) { return f >= l.reject; }),
                1e-13);
  }
}

TEST(GroupSequential, OneLookIsTheExactBinomial) {
  for (const std::int64_t n : {1, 500, 851, 852, 2000, 5000, 1000000}) {
    const auto looks = Boundaries({}, 0.9973, 0.10, n);
    ASSERT_EQ(looks.size(), 1u);
    EXPECT_EQ(looks[0].n, n);
    EXPECT_EQ(looks[0].accept, MaxFailures(0.9973, 0.10, n).value_or(-1));
    EXPECT_LE(ProducerRisk(0.9973, n, looks[0].reject), 0.10);
    EXPECT_GT(ProducerRisk(0.9973, n, looks[0].reject - 1), 0.10);
    if (looks[0].accept >= 0) {
      EXPECT_NEAR(PassRisk(0.9973, looks), ConsumerRisk(0.9973, n, looks[0].accept), 1e-12);
    }
  }
}

// A pass at 852 cases without a failure, else at 1440 with one: what "cases needed" leads to when it is
// followed after each look. Stated 10 %.
TEST(GroupSequential, FollowingCasesNeededHasTheRiskThatItHas) {
  std::vector<LookBoundary> looks;
  for (std::int64_t failures = 0; failures < 40; ++failures) {
    const std::int64_t n = CasesNeeded(0.9973, 0.10, failures);
    looks.push_back({n, failures, n + 1});
    const double risk = PassRisk(0.9973, looks);
    // P(0 of 852) + P(1 or more of 852, and at most 1 of 1440), which is one of 852 and none of 588.
    const double none = std::pow(0.9973, 852);
    const double one_more =
        failures == 0 ? 0.0 : 852 * 0.0027 * std::pow(0.9973, 851) * std::pow(0.9973, 588);
    if (failures <= 1) {
      EXPECT_NEAR(risk, none + one_more, 1e-12);
    }
  }
  EXPECT_NEAR(PassRisk(0.9973, looks), 0.388, 0.001);
}

TEST(GroupSequential, PlannedLooksSpendNoMoreThanTheirRisk) {
  for (const double probability : {0.5, 0.9, 0.9973, 0.99865}) {
    for (const double risk : {0.01, 0.1, 0.4}) {
      for (const Spending spending : {Spending::kOBrienFleming, Spending::kPocock}) {
        for (const std::int64_t count : {2, 5, 20}) {
          const auto looks =
              Boundaries({PlanKind::kGroupSequential, count, spending}, probability, risk, 3000);
          ASSERT_EQ(std::ssize(looks), count);
          EXPECT_LE(PassRisk(probability, looks), risk + 1e-12);
          EXPECT_LE(FailRisk(probability, looks), risk + 1e-12);
          for (std::size_t i = 0; i < looks.size(); ++i) {
            EXPECT_LT(looks[i].accept, looks[i].reject);
            if (i > 0) {
              EXPECT_GE(looks[i].accept, looks[i - 1].accept);
            }
            // One failure more would have spent too much.
            auto wider = looks;
            ++wider[i].accept;
            wider.resize(i + 1);
            const double share = static_cast<double>(looks[i].n) / 3000.0;
            if (spending == Spending::kPocock && looks[i].accept < looks[i].n) {
              EXPECT_GT(PassRisk(probability, wider),
                        risk * std::log1p((std::exp(1.0) - 1.0) * share) - 1e-12);
            }
          }
        }
      }
    }
  }
}

// O'Brien and Fleming's spending by its formula at half the cases, risk 10 %: 2 - 2 Phi(1.644854 / sqrt 0.5)
// = 0.02001, to which the first of two looks keeps.
TEST(GroupSequential, OBrienFlemingSpendsLittleEarly) {
  const auto looks = Boundaries({PlanKind::kGroupSequential, 2, Spending::kOBrienFleming}, 0.9, 0.10, 1000);
  EXPECT_LE(ConsumerRisk(0.9, 500, looks[0].accept), 0.02001);
  EXPECT_GT(ConsumerRisk(0.9, 500, looks[0].accept + 1), 0.02001);
  EXPECT_LE(ProducerRisk(0.9, 500, looks[0].reject), 0.02001);
  EXPECT_GT(ProducerRisk(0.9, 500, looks[0].reject - 1), 0.02001);
}

TEST(GroupSequential, LooksAreCountedInIntegers) {
  EXPECT_THAT(LookCounts({}, 5000), ElementsAre(5000));
  EXPECT_THAT(LookCounts({PlanKind::kGroupSequential, 3, Spending::kPocock}, 100), ElementsAre(34, 67, 100));
  EXPECT_THAT(LookCounts({PlanKind::kGroupSequential, 5, Spending::kPocock}, 3), ElementsAre(1, 2, 3));
  EXPECT_THAT(LookCounts({PlanKind::kGroupSequential, 3, Spending::kPocock}, 4294967295),
              ElementsAre(1431655765, 2863311530, 4294967295));
  EXPECT_TRUE(LookCounts({PlanKind::kAnytime, 1, Spending::kPocock}, 100).empty());
}

}  // namespace dispersa::statistics_group_sequential_test
