#include "core/statistics/tolerance.h"

#include <gtest/gtest.h>

#include "tests/unit/read_csv.h"

namespace dispersa::statistics_tolerance_test {
namespace {

TEST(Wilks, MatchesSciPy) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/stats/wilks.csv");
  ASSERT_EQ(rows.size(), 15u);
  for (const auto& row : rows) {
    for (std::int64_t order = 1; order <= 5; ++order) {
      EXPECT_EQ(WilksOneSided(row[0], row[1], order), static_cast<std::int64_t>(row[1 + order]))
          << row[0] << " " << row[1] << " " << order;
    }
    EXPECT_EQ(WilksTwoSided(row[0], row[1]), static_cast<std::int64_t>(row[7])) << row[0] << " " << row[1];
  }
}

TEST(NormalToleranceFactor, MatchesSciPy) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/stats/normal_one_sided_k.csv");
  ASSERT_EQ(rows.size(), 50u);
  for (const auto& row : rows) {
    const double factor = NormalToleranceFactor(static_cast<std::int64_t>(row[0]), row[1], row[2]);
    // The reference is printed to 8 decimals.
    EXPECT_NEAR(factor, row[3], 1e-8) << row[0] << " " << row[1] << " " << row[2];
  }
}

}  // namespace
}  // namespace dispersa::statistics_tolerance_test
