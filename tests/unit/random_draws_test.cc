#include "core/random/draws.h"
#include "tests/test.h"

#include <Random123/philox.h>

namespace dispersa::random_draws_test {
namespace {

constexpr std::uint64_t kSeed = 20260101;

// sqrt(N) D of Kolmogorov and Smirnov's test: exceeded by 1 of 1000 correct generators. The seeds are fixed,
// so a passing test stays passed.
constexpr double kKolmogorovLimit = 1.949;

template <typename Cdf>
double KolmogorovStatistic(std::vector<double> values, Cdf cdf) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double p = cdf(values[i]);
    distance = std::max({distance, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return distance * std::sqrt(n);
}

double Correlation(const std::vector<double>& x, const std::vector<double>& y) {
  // Of uniform values: mean 1/2, variance 1/12.
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - 0.5) * (y[i] - 0.5);
  return 12.0 * sum / static_cast<double>(x.size());
}

// The generator's own known answers: Random123, tests/kat_vectors, "philox4x32 10".
TEST(Philox, KnownAnswers) {
  const r123::Philox4x32 philox;
  const std::uint32_t ones = 0xffffffff;
  EXPECT_THAT(philox({{0, 0, 0, 0}}, {{0, 0}}), ElementsAre(0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8));
  EXPECT_THAT(philox({{ones, ones, ones, ones}}, {{ones, ones}}),
              ElementsAre(0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd));
  EXPECT_THAT(philox({{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, {{0xa4093822, 0x299f31d0}}),
              ElementsAre(0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1));
}

// Known answers of the hash's authors (FNV test suite, fnv_test_str).
TEST(HashName, KnownAnswers) {
  EXPECT_EQ(HashName(""), 0xcbf29ce484222325u);
  EXPECT_EQ(HashName("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(HashName("foobar"), 0x85944171f73967e8u);
}

// The documented layout of key, counter and words; the numbers are from a separate program that writes
// Philox's ten rounds out.
TEST(Stream, MapsSeedIndexNameAndDrawToTheCounter) {
  Stream stream(kSeed, 7, "thrust/stage1");
  EXPECT_EQ(stream.Bits(), 0x688c624034abdf3cu);
  EXPECT_EQ(stream.Bits(), 0xa1bc5975f5906fe8u);
  EXPECT_EQ(stream.Bits(), 0xe7c2ece93743375du);
  EXPECT_EQ(stream.Bits(), 0x461c900b8c1d6de9u);

  Stream extreme(0xfedcba9876543210, 0xffffffff, "thrust/stage1");
  EXPECT_EQ(extreme.Bits(), 0x971c0a40b23922a9u);
  EXPECT_EQ(extreme.Bits(), 0xeddb3f4a95610b83u);
  EXPECT_EQ(extreme.Bits(), 0x203ffe7b97ade0c1u);
  EXPECT_EQ(extreme.Bits(), 0x3a0adb833057dfe6u);
}

TEST(Stream, IsUntouchedByOtherParametersAndCases) {
  Stream alone(kSeed, 42, "wind/azimuth");
  const std::vector<double> expected = {alone.Uniform(), alone.Uniform(), alone.Uniform()};

  Stream wind(kSeed, 42, "wind/azimuth");
  Stream added(kSeed, 42, "mass");
  Stream other_case(kSeed, 41, "wind/azimuth");
  std::vector<double> interleaved;
  for (int i = 0; i < 3; ++i) {
    other_case.Bits();
    interleaved.push_back(wind.Uniform());
    added.Bits();
  }
  EXPECT_EQ(interleaved, expected);
}

TEST(Stream, DependsOnEachPartOfItsKey) {
  const std::uint64_t bits = Stream(kSeed, 3, "cd").Bits();
  EXPECT_NE(Stream(kSeed + 1, 3, "cd").Bits(), bits);
  EXPECT_NE(Stream(kSeed + (std::uint64_t{1} << 32), 3, "cd").Bits(), bits);
  EXPECT_NE(Stream(kSeed, 4, "cd").Bits(), bits);
  EXPECT_NE(Stream(kSeed, 3, "cl").Bits(), bits);
}

TEST(OpenUnitInterval, LeavesOutTheEndsAndIsSymmetric) {
  const std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(OpenUnitInterval(0), 0x1p-53);
  EXPECT_EQ(OpenUnitInterval(all), 1.0 - 0x1p-53);
  for (const std::uint64_t bits : {std::uint64_t{1} << 63, std::uint64_t{0x0123456789abcdef}}) {
    EXPECT_EQ(OpenUnitInterval(bits), 1.0 - OpenUnitInterval(~bits));
  }
}

TEST(Stream, CasesAreUniformAndNormal) {
  for (const char* name : {"thrust/stage1", "drag_coefficient"}) {
    std::vector<double> uniform;
    std::vector<double> normal;
    for (std::uint64_t index = 0; index < 100000; ++index) {
      Stream stream(kSeed, index, name);
      uniform.push_back(stream.Uniform());
      normal.push_back(stream.Normal());
    }
    EXPECT_LT(KolmogorovStatistic(uniform, [](double u) { return u; }), kKolmogorovLimit) << name;
    EXPECT_LT(KolmogorovStatistic(normal, [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }),
              kKolmogorovLimit)
        << name;
  }
}

TEST(Stream, NeighboursAreUncorrelated) {
  constexpr std::size_t kCases = 100000;
  std::vector<double> base, next_draw, next_case, next_seed, next_name;
  for (std::size_t i = 0; i < kCases; ++i) {
    Stream stream(kSeed, i, "stage1");
    base.push_back(stream.Uniform());
    next_draw.push_back(stream.Uniform());
    next_case.push_back(Stream(kSeed, i + 1, "stage1").Uniform());
    next_seed.push_back(Stream(kSeed + 1, i, "stage1").Uniform());
    next_name.push_back(Stream(kSeed, i, "stage2").Uniform());
  }
  // Five standard errors.
  const double limit = 5.0 / std::sqrt(static_cast<double>(kCases));
  EXPECT_LT(std::fabs(Correlation(base, next_draw)), limit);
  EXPECT_LT(std::fabs(Correlation(base, next_case)), limit);
  EXPECT_LT(std::fabs(Correlation(base, next_seed)), limit);
  EXPECT_LT(std::fabs(Correlation(base, next_name)), limit);
}

}  // namespace
}  // namespace dispersa::random_draws_test
