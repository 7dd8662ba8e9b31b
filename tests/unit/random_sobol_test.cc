#include "core/random/sobol.h"

#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/read_csv.h"

namespace dispersa::random_sobol_test {
namespace {

std::vector<std::string> Names(std::size_t dimensions) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < dimensions; ++i) names.push_back(std::to_string(i));
  return names;
}

TEST(Sobol, MatchesJoeAndKuo) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/stats/sobol_joekuo_first32_d10.csv");
  ASSERT_EQ(rows.size(), 32u);
  const Sobol sobol(1, Names(10));
  for (std::uint64_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 11u);
    EXPECT_EQ(rows[i][0], static_cast<double>(i));
    for (std::size_t dimension = 0; dimension < 10; ++dimension) {
      EXPECT_EQ(sobol.Unshifted(i, dimension), rows[i][1 + dimension]) << "point " << i << ", " << dimension;
    }
  }
}

// Any aligned block of 2^k points has one in each of 2^k strata, in every dimension of the tables, with the
// shift as without.
TEST(Sobol, StratifiesEveryDimension) {
  constexpr std::uint64_t kBlock = 64;
  const Sobol sobol(20260101, Names(Sobol::kMaxDimensions));
  for (std::size_t dimension = 0; dimension < sobol.dimensions(); ++dimension) {
    for (const std::uint64_t start : {std::uint64_t{0}, 5 * kBlock, Sobol::kMaxCases - kBlock}) {
      std::set<int> strata;
      std::set<int> shifted_strata;
      for (std::uint64_t i = start; i < start + kBlock; ++i) {
        const double u = sobol.Uniform(i, dimension);
        EXPECT_GT(u, 0.0);
        EXPECT_LT(u, 1.0);
        strata.insert(static_cast<int>(kBlock * sobol.Unshifted(i, dimension)));
        shifted_strata.insert(static_cast<int>(kBlock * u));
      }
      EXPECT_EQ(strata.size(), kBlock) << dimension;
      EXPECT_EQ(shifted_strata.size(), kBlock) << dimension;
    }
  }
}

// The first two dimensions are a (0, 2)-sequence: one of 256 points in each box of 2^-j by 2^-(8-j).
TEST(Sobol, FirstTwoDimensionsFillEveryElementaryBox) {
  const Sobol sobol(7, Names(2));
  for (int j = 0; j <= 8; ++j) {
    std::set<std::pair<int, int>> boxes;
    for (std::uint64_t i = 0; i < 256; ++i) {
      boxes.emplace(static_cast<int>(std::ldexp(sobol.Uniform(i, 0), j)),
                    static_cast<int>(std::ldexp(sobol.Uniform(i, 1), 8 - j)));
    }
    EXPECT_EQ(boxes.size(), 256u) << j;
  }
}

TEST(Sobol, TheShiftDependsOnSeedAndName) {
  const Sobol sobol(1, {"thrust", "wind"});
  EXPECT_EQ(sobol.Uniform(0, 0), OpenUnitInterval(Stream(1, 0, "thrust/shift").Bits()));
  EXPECT_EQ(sobol.Uniform(0, 1), OpenUnitInterval(Stream(1, 0, "wind/shift").Bits()));
  EXPECT_NE(sobol.Uniform(9, 0), Sobol(2, {"thrust"}).Uniform(9, 0));
  EXPECT_NE(sobol.Uniform(9, 0), Sobol(1, {"mass"}).Uniform(9, 0));
  EXPECT_EQ(sobol.Uniform(9, 0), Sobol(1, {"thrust"}).Uniform(9, 0));
}

// The shift leaves the mean unbiased: averaged over seeds, any one point is uniform.
TEST(Sobol, APointIsUniformOverSeeds) {
  constexpr int kSeeds = 10000;
  double mean = 0.0;
  double square = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const double u = Sobol(static_cast<std::uint64_t>(seed), {"x"}).Uniform(3, 0);
    mean += u / kSeeds;
    square += u * u / kSeeds;
  }
  // Four standard errors: sqrt(1/12 / n) = 0.0029, and sqrt(4/45 / n) = 0.0030.
  EXPECT_NEAR(mean, 1.0 / 2.0, 0.0116);
  EXPECT_NEAR(square, 1.0 / 3.0, 0.0120);
}

// In 21 dimensions, a smooth product integrates far better than with independent draws.
TEST(Sobol, IntegratesBetterThanIndependentDraws) {
  constexpr std::size_t kDimensions = 21;
  constexpr std::uint64_t kCases = 4096;
  const std::vector<std::string> names = Names(kDimensions);
  double sobol_error = 0.0;
  double independent_error = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Sobol sobol(seed, names);
    double sobol_mean = 0.0;
    double independent_mean = 0.0;
    for (std::uint64_t i = 0; i < kCases; ++i) {
      double product = 1.0;
      double independent_product = 1.0;
      for (std::size_t d = 0; d < kDimensions; ++d) {
        const double weight = 1.0 / static_cast<double>((d + 1) * (d + 1));
        product *= 1.0 + weight * (sobol.Uniform(i, d) - 0.5);
        independent_product *= 1.0 + weight * (Stream(seed, i, names[d]).Uniform() - 0.5);
      }
      sobol_mean += product / kCases;
      independent_mean += independent_product / kCases;
    }
    sobol_error += std::pow(sobol_mean - 1.0, 2);
    independent_error += std::pow(independent_mean - 1.0, 2);
  }
  // Independent draws need 400 times the cases for a 20th of the error.
  EXPECT_LT(std::sqrt(sobol_error), std::sqrt(independent_error) / 20.0);
}

}  // namespace
}  // namespace dispersa::random_sobol_test
