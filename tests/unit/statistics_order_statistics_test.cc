#include "core/statistics/order_statistics.h"

#include "tests/test.h"
#include "tests/unit/read_csv.h"

namespace dispersa::statistics_order_statistics_test {
namespace {

// SciPy's figures are printed with 10 digits.
constexpr double kPrinted = 1e-9;

TEST(CasesNeeded, MatchesSciPy) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/stats/order_stats_min_N.csv");
  ASSERT_EQ(rows.size(), 156u);
  for (const auto& row : rows) {
    const double reliability = row[0];
    const double risk = 1.0 - row[1];
    const auto failures = static_cast<std::int64_t>(row[2]);
    const auto n = static_cast<std::int64_t>(row[3]);
    EXPECT_EQ(CasesNeeded(reliability, risk, failures), n) << reliability << " " << risk << " " << failures;
    EXPECT_NEAR(ConsumerRisk(reliability, n, failures), row[4], kPrinted * row[4]);
    EXPECT_NEAR(ConsumerRisk(reliability, n - 1, failures), row[5], kPrinted * row[5]);
  }
}

// NASA/TP-2010-216447's kind of table at a consumer's risk of 10 %.
TEST(CasesNeeded, TenPercentTable) {
  const struct {
    double probability;
    std::int64_t cases[4];
  } rows[] = {{0.99865, {1705, 2880, 3941, 4947}},
              {0.9973, {852, 1440, 1970, 2473}},
              {0.997, {767, 1296, 1773, 2226}},
              {0.99, {230, 388, 531, 667}},
              {0.95, {45, 77, 105, 132}}};
  for (const auto& row : rows) {
    for (std::int64_t failures = 0; failures < 4; ++failures) {
      EXPECT_EQ(CasesNeeded(row.probability, 0.10, failures), row.cases[failures]) << row.probability;
    }
  }
}

TEST(MaxFailures, InvertsCasesNeeded) {
  EXPECT_EQ(MaxFailures(0.9973, 0.10, 2000), 2);
  EXPECT_EQ(MaxFailures(0.9973, 0.10, 0), std::nullopt);
  EXPECT_EQ(MaxFailures(0.9973, 0.10, 851), std::nullopt);
  for (std::int64_t failures = 0; failures < 30; ++failures) {
    const std::int64_t n = CasesNeeded(0.95, 0.10, failures);
    EXPECT_EQ(MaxFailures(0.95, 0.10, n), failures);
    EXPECT_EQ(MaxFailures(0.95, 0.10, n - 1).value_or(-1), failures - 1);
  }
}

// Powers of two are exact, so the comparison with the risk is at its border: it includes equality.
TEST(CasesNeeded, IncludesEquality) {
  EXPECT_EQ(ConsumerRisk(0.5, 3, 0), 0.125);
  EXPECT_EQ(CasesNeeded(0.5, 0.125, 0), 3);
  EXPECT_EQ(MaxFailures(0.5, 0.125, 3), 0);
}

// Sums of binomial terms, small enough to be written out: n = 4, p = 3/4.
TEST(Risks, MatchBinomialTerms) {
  const double terms[] = {81.0 / 256, 108.0 / 256, 54.0 / 256, 12.0 / 256, 1.0 / 256};
  double at_most = 0.0;
  for (std::int64_t failures = 0; failures <= 4; ++failures) {
    EXPECT_NEAR(ProducerRisk(0.75, 4, failures), 1.0 - at_most, 1e-15);
    at_most += terms[failures];
    EXPECT_NEAR(ConsumerRisk(0.75, 4, failures), at_most, 1e-15);
  }
  EXPECT_EQ(ConsumerRisk(0.75, 4, 5), 1.0);
  EXPECT_EQ(ProducerRisk(0.75, 4, 5), 0.0);
  EXPECT_EQ(ConsumerRisk(0.75, 0, 0), 1.0);
  EXPECT_EQ(ProducerRisk(0.75, 0, 0), 1.0);
}

TEST(CasesNeeded, ReachesSixNines) {
  // 0 failures: the power is explicit.
  const auto expected = static_cast<std::int64_t>(std::ceil(std::log(0.1) / std::log1p(-1e-6)));
  EXPECT_EQ(CasesNeeded(1.0 - 1e-6, 0.1, 0), expected);
}

}  // namespace
}  // namespace dispersa::statistics_order_statistics_test
