// Samples on a circle, unwrapped about their centre.
#include "core/math/circle.h"

#include "core/statistics/limits.h"
#include "core/statistics/normal.h"
#include "core/statistics/summary.h"
#include "tests/test.h"

namespace dispersa::math_circle_test {
namespace {

struct Sample {
  const char* name;
  Circle circle;
  std::vector<double> values;
  std::optional<double> centre;
  std::vector<double> unwrapped;
};

const Sample kSamples[] = {
    {"east of 180", kCutAt180Deg, {179.0, -179.0, -178.0}, -179.333, {-181.0, -179.0, -178.0}},
    {"west of 180", kCutAt180Deg, {-179.0, 179.0, 178.0}, 179.333, {181.0, 179.0, 178.0}},
    {"about 0, cut at 180", kCutAt180Deg, {-1.0, 2.0, 5.0}, 2.0, {-1.0, 2.0, 5.0}},
    {"above 0, cut at 0", kCutAt0Deg, {359.0, 1.0, 3.0}, 1.0, {-1.0, 1.0, 3.0}},
    {"below 0, cut at 0", kCutAt0Deg, {357.0, 359.0, 1.0}, 359.0, {357.0, 359.0, 361.0}},
    {"two at a right angle", kCutAt180Deg, {135.0, -135.0}, -180.0, {-225.0, -135.0}},
    {"nearly half a turn", kCutAt0Deg, {0.0, 90.0, 179.0}, 89.991, {0.0, 90.0, 179.0}},
    {"two opposite ones", kCutAt180Deg, {-90.0, 90.0}, std::nullopt, {-90.0, 90.0}},
    {"a third of a turn apart", kCutAt0Deg, {0.0, 120.0, 240.0}, std::nullopt, {0.0, 120.0, 240.0}},
    {"no circle", Circle{}, {179.0, -179.0}, std::nullopt, {179.0, -179.0}},
    {"none", kCutAt180Deg, {}, std::nullopt, {}},
};

TEST(Circle, UnwrapsASampleAboutItsCentre) {
  for (const Sample& sample : kSamples) {
    SCOPED_TRACE(sample.name);
    const std::optional<double> centre = CentreOf(sample.values, sample.circle);
    ASSERT_EQ(centre.has_value(), sample.centre.has_value());
    EXPECT_NEAR(centre.value_or(0.0), sample.centre.value_or(0.0), 0.02);
    const bool around = sample.circle.is_closed() && !sample.values.empty() && !sample.centre;
    EXPECT_EQ(LiesAllAround(sample.values, sample.circle), around);
    EXPECT_EQ(Unwrapped(sample.values, sample.circle), sample.unwrapped);
  }
}

TEST(Circle, LeavesBitsAndUndefinedValuesAlone) {
  const double nan = std::nan("");
  const std::vector<double> values = Unwrapped({179.98, nan, 179.9}, kCutAt180Deg);
  EXPECT_EQ(values[0], 179.98);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 179.9);
  EXPECT_EQ(NearTo(0.0, std::numeric_limits<double>::infinity(), kCutAt180Deg),
            std::numeric_limits<double>::infinity());
}

// Of many values the resultant decides: a wide bell has a centre, a uniform sample has none.
TEST(Circle, AWideBellHasACentreAndAUniformSampleHasNone) {
  std::vector<double> bell, uniform;
  for (int i = 0; i < 1000; ++i) {
    const double turn = 0.36 * i;
    uniform.push_back(turn);
    bell.push_back(NearTo(180.0, 350.0 + 60.0 * NormalQuantile((i + 0.5) / 1000.0), kCutAt0Deg));
  }
  EXPECT_FALSE(CentreOf(uniform, kCutAt0Deg));
  ASSERT_TRUE(CentreOf(bell, kCutAt0Deg));
  EXPECT_NEAR(*CentreOf(bell, kCutAt0Deg), 350.0, 0.1);
}

TEST(Circle, StatisticsDoNotSeeTheCut) {
  for (const double site : {179.98, -179.98, 20.0}) {
    std::vector<double> values;
    for (int i = -30; i <= 30; ++i) values.push_back(NearTo(0.0, site + 0.001 * i, kCutAt180Deg));
    const Summary summary = Summarize(values, kCutAt180Deg);
    EXPECT_EQ(summary.n, 61u);
    EXPECT_NEAR(summary.mean, site, 1e-9);
    EXPECT_NEAR(summary.std, 0.001 * std::sqrt(61.0 * 62.0 / 12.0), 1e-9);
    EXPECT_NEAR(summary.p50, site, 1e-9);
    EXPECT_NEAR(summary.max - summary.min, 0.06, 1e-9);
  }
  const Summary around = Summarize({0.0, 90.0, 180.0, 270.0, std::nan("")}, kCutAt0Deg);
  EXPECT_TRUE(IsAllAround(around));
  EXPECT_EQ(around.n, 4u);
  EXPECT_EQ(around.undefined, 1u);
  for (const double value : {around.mean, around.std, around.min, around.max, around.p50})
    EXPECT_TRUE(std::isnan(value));
}

struct Held {
  double low, high, value;
  bool meets;
  double margin;
};

constexpr double kNone = std::numeric_limits<double>::infinity();
const Held kHeld[] = {
    {179.9, kNone, 179.95, true, 0.05},      {179.9, kNone, -179.95, true, 0.15},
    {179.9, kNone, 179.85, false, -0.05},    {179.9, kNone, 0.0, false, -179.9},
    {-kNone, -179.9, -179.95, true, 0.05},   {-kNone, -179.9, 179.95, true, 0.15},
    {-kNone, -179.9, -179.85, false, -0.05}, {179.0, 181.0, -179.5, true, 0.5},
    {179.0, 181.0, -178.5, false, -0.5},     {-181.0, -179.0, 179.5, true, 0.5},
    {-181.0, -179.0, 178.5, false, -0.5},    {0.0, 300.0, -80.0, true, 20.0},
    {-300.0, 0.0, 80.0, true, 20.0},
};

TEST(Circle, ALimitHoldsAgainstTheNearestRepresentation) {
  for (const Held& held : kHeld) {
    SCOPED_TRACE(held.value);
    const Limits limits{held.low, held.high, kCutAt180Deg};
    EXPECT_EQ(limits.Meets(held.value), held.meets);
    EXPECT_NEAR(limits.Margin(held.value), held.margin, 1e-9);
  }
  const Limits above{179.9, kNone, kCutAt180Deg};
  EXPECT_TRUE(above.IsWorse(179.95, -179.95));
  EXPECT_FALSE(above.IsWorse(-179.95, 179.95));
  EXPECT_FALSE(above.Meets(std::nan("")));
}

}  // namespace
}  // namespace dispersa::math_circle_test
