#include "core/random/normal.h"
#include "tests/test.h"

#include <boost/math/distributions/normal.hpp>

namespace dispersa::random_normal_test {
namespace {

// Quantiles to 17 digits by Newton's method on the complementary error function with 60 digits, at the double
// nearest to p. All three ranges of the algorithm and both sides of their borders occur.
TEST(InverseNormal, MatchesHighPrecision) {
  struct Reference {
    double p;
    double x;
  };
  const Reference references[] = {
      {1e-300, -37.047096299361199},    {1e-100, -21.273453560965324},
      {1e-20, -9.2623400897984076},     {0x1p-52, -8.1258906647019069},
      {1e-15, -7.9413453261709970},     {1e-13, -7.3487961028006775},
      {1e-10, -6.3613409024040562},     {1.38879438649640206e-11, -6.6579046435011036},
      {0.001, -3.0902323061678135},     {0.0013498980316300946, -3.0},
      {0.01, -2.3263478740408411},      {0.0749999, -1.4395321773759006},
      {0.0750001, -1.4395307645017297}, {0.25, -0.67448975019608174},
      {0.4, -0.25334710313579974},      {0.6, 0.25334710313579974},
      {0.9, 1.2815515655446006},        {0.9986501019683699, 2.9999999999999980},
      {0.999999, 4.7534243088170878}};
  for (const Reference& reference : references) {
    // AS 241 states about 1 part in 1e16; its fifteen roundings add to that.
    EXPECT_NEAR(InverseNormal(reference.p), reference.x, 1e-15 * std::fabs(reference.x)) << reference.p;
  }
  EXPECT_EQ(InverseNormal(0.5), 0.0);
}

TEST(InverseNormal, MatchesBoostEverywhere) {
  const boost::math::normal normal;
  double worst = 0.0;
  for (int i = 1; i < 100000; ++i) {
    const double p = i * 1e-5;
    if (p == 0.5) continue;
    const double expected = quantile(normal, p);
    worst = std::max(worst, std::fabs(InverseNormal(p) / expected - 1.0));
  }
  // Both sides' roundings.
  EXPECT_LT(worst, 2e-15);
}

TEST(InverseNormal, IsOddAndIncreasing) {
  double last = -std::numeric_limits<double>::infinity();
  for (int i = 1; i < 4096; ++i) {
    const double p = i * 0x1p-12;
    const double x = InverseNormal(p);
    EXPECT_EQ(x, -InverseNormal(1.0 - p));
    EXPECT_GT(x, last);
    last = x;
  }
}

TEST(InverseNormal, EndsAndOutside) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(InverseNormal(0.0), -infinity);
  EXPECT_EQ(InverseNormal(1.0), infinity);
  EXPECT_TRUE(std::isnan(InverseNormal(-1e-9)));
  EXPECT_TRUE(std::isnan(InverseNormal(1.0 + 1e-9)));
  EXPECT_TRUE(std::isnan(InverseNormal(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace dispersa::random_normal_test
