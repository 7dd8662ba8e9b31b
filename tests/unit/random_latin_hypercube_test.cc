#include "core/random/latin_hypercube.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::random_latin_hypercube_test {
namespace {

TEST(LatinHypercube, HasOneCaseInEachStratum) {
  // 5000 is no power of two, so that a boundary hit by rounding would show.
  for (const std::uint64_t cases : {1, 7, 5000}) {
    const LatinHypercube design(20260101, cases, {"thrust", "mass", "wind"});
    for (std::size_t dimension = 0; dimension < design.dimensions(); ++dimension) {
      std::set<int> strata;
      for (std::uint64_t i = 0; i < cases; ++i) {
        const double u = design.Uniform(i, dimension);
        EXPECT_GT(u, 0.0);
        EXPECT_LT(u, 1.0);
        strata.insert(static_cast<int>(u * static_cast<double>(cases)));
      }
      EXPECT_EQ(strata.size(), cases);
      EXPECT_EQ(*strata.begin(), 0);
      EXPECT_EQ(*strata.rbegin(), static_cast<int>(cases) - 1);
    }
  }
}

TEST(LatinHypercube, ADimensionDependsOnItsNameAlone) {
  const LatinHypercube one(1, 100, {"wind"});
  const LatinHypercube many(1, 100, {"thrust", "wind", "mass"});
  const LatinHypercube other_seed(2, 100, {"wind"});
  int equal_to_other_dimension = 0;
  int equal_to_other_seed = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(one.Uniform(i, 0), many.Uniform(i, 1));
    equal_to_other_dimension += many.Uniform(i, 0) == many.Uniform(i, 1);
    equal_to_other_seed += one.Uniform(i, 0) == other_seed.Uniform(i, 0);
  }
  EXPECT_EQ(equal_to_other_dimension, 0);
  EXPECT_EQ(equal_to_other_seed, 0);
}

TEST(LatinHypercube, EachDimensionHasAPermutationOfItsOwn) {
  const LatinHypercube design(1, 100, {"thrust", "wind"});
  int same_stratum = 0;
  for (std::uint64_t i = 0; i < 100; ++i)
    same_stratum +=
        static_cast<int>(100.0 * design.Uniform(i, 0)) == static_cast<int>(100.0 * design.Uniform(i, 1));
  EXPECT_LT(same_stratum, 7) << "1 is expected of independent permutations";
}

TEST(LatinHypercube, PermutationsAreEquallyLikely) {
  std::map<std::array<int, 4>, int> counts;
  constexpr int kSeeds = 24000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const LatinHypercube design(seed, 4, {"x"});
    std::array<int, 4> permutation;
    for (std::uint64_t i = 0; i < 4; ++i) permutation[i] = static_cast<int>(4.0 * design.Uniform(i, 0));
    ++counts[permutation];
  }
  ASSERT_EQ(counts.size(), 24u);
  double chi_square = 0.0;
  for (const auto& [permutation, count] : counts) chi_square += std::pow(count - 1000.0, 2) / 1000.0;
  // 99.9 % point of chi-square with 23 degrees of freedom; the seeds are fixed.
  EXPECT_LT(chi_square, 49.73);
}

// The shuffle draws below a bound, from 2^32 numbers. If they do not divide evenly, some results would have
// one number more than the others. Such a first number is drawn again. With this number of cases it happens a
// few times. Without it, all later draws are another permutation.
TEST(LatinHypercube, DrawsAgainWhatWouldFavourAStratum) {
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32, kCases = 300000;
  std::vector<std::uint32_t> strata(kCases);
  std::iota(strata.begin(), strata.end(), 0u);
  Stream stream(5, 0, "thrust/permutation");
  int drawn_again = 0;
  for (std::uint64_t left = kCases; left > 1; --left) {
    for (;;) {
      const std::uint64_t number = stream.Bits() >> 32, result = number * left / kAll;
      const auto first_of = [&](std::uint64_t r) { return (r * kAll + left - 1) / left; };
      const bool has_one_more = first_of(result + 1) - first_of(result) > kAll / left;
      if (has_one_more && number == first_of(result)) {
        ++drawn_again;
        continue;
      }
      std::swap(strata[left - 1], strata[result]);
      break;
    }
  }
  ASSERT_GT(drawn_again, 0);
  const LatinHypercube design(5, kCases, {"thrust"});
  std::uint64_t different = 0;
  for (std::uint64_t i = 0; i < kCases; ++i)
    different += static_cast<std::uint32_t>(design.Uniform(i, 0) * static_cast<double>(kCases)) != strata[i];
  EXPECT_EQ(different, 0u) << drawn_again << " numbers were to be drawn again";
}

// The point of the design: the mean of a sum over dimensions varies by 1/N² per dimension instead of 1/N.
TEST(LatinHypercube, AveragesSumsBetterThanIndependentDraws) {
  constexpr std::uint64_t kCases = 100;
  constexpr int kReplicates = 200;
  double squared_error = 0.0;
  for (int seed = 0; seed < kReplicates; ++seed) {
    const LatinHypercube design(static_cast<std::uint64_t>(seed), kCases, {"x", "y", "z"});
    double mean = 0.0;
    for (std::uint64_t i = 0; i < kCases; ++i) {
      mean += (design.Uniform(i, 0) + design.Uniform(i, 1) + design.Uniform(i, 2)) / kCases;
    }
    squared_error += (mean - 1.5) * (mean - 1.5) / kReplicates;
  }
  // Jitter within strata: 3 / (12 N^3); the estimate from 200 replicates has a relative error of 10 %.
  const double expected = 3.0 / 12.0 / std::pow(kCases, 3);
  EXPECT_NEAR(squared_error / expected, 1.0, 0.4);
}

}  // namespace
}  // namespace dispersa::random_latin_hypercube_test
