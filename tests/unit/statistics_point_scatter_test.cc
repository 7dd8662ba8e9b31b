#include "core/statistics/point_scatter.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::statistics_point_scatter_test {
namespace {

/// Correlated normals of the given spread.
std::vector<std::vector<double>> Normals(int n, int dimensions) {
  std::vector<std::vector<double>> points;
  for (int i = 0; i < n; ++i) {
    Stream stream(3, static_cast<std::uint64_t>(i), "ellipse");
    const double x = stream.Normal(), y = stream.Normal(), z = stream.Normal();
    points.push_back({100.0 + 3.0 * x, -7.0 + 2.0 * x + y});
    if (dimensions == 3) points.back().push_back(1e-3 * (x - z));
  }
  return points;
}

TEST(PointScatter, ScatterOfAFewPoints) {
  const PointScatter scatter = PointScatterOf({{1, 10}, {2, 30}, {3, 20}});
  EXPECT_EQ(scatter.mean, (std::vector<double>{2, 20}));
  EXPECT_EQ(scatter.covariance[0][0], 1.0);
  EXPECT_EQ(scatter.covariance[0][1], 5.0);
  EXPECT_EQ(scatter.covariance[1][1], 100.0);
  EXPECT_EQ(PointScatterOf({}).n, 0u);
}

TEST(PointScatter, HoldsTheStatedShareOfNormalPoints) {
  for (const int dimensions : {2, 3}) {
    const auto points = Normals(20000, dimensions);
    const PointScatter scatter = PointScatterOf(points);
    for (const Containment& one : ContainmentOf(points, scatter, {0.5, 0.95, 0.99})) {
      // Four standard errors of 20,000 points.
      EXPECT_NEAR(one.empirical, one.stated, 4.0 * std::sqrt(one.stated * (1.0 - one.stated) / 20000.0))
          << dimensions;
      EXPECT_LT(one.limits.lower, one.empirical);
      EXPECT_GT(one.limits.upper, one.empirical);
      // Two dimensions in closed form.
      if (dimensions == 2) {
        EXPECT_NEAR(one.scale, -2.0 * std::log(1.0 - one.stated), 1e-12);
      }
    }
  }
  EXPECT_NEAR(PointScatterOf(Normals(20000, 2)).covariance[0][1], 6.0, 0.3);
}

TEST(PointScatter, SaysSoWhenPointsAreNotNormal) {
  std::vector<std::vector<double>> ring;
  for (int i = 0; i < 360; ++i)
    ring.push_back({std::cos(i * std::numbers::pi / 180), std::sin(i * std::numbers::pi / 180)});
  const auto containment = ContainmentOf(ring, PointScatterOf(ring), {0.5, 0.95});
  EXPECT_EQ(containment[0].inside, 0);
  EXPECT_EQ(containment[1].inside, 360);
}

TEST(PointScatter, NoneWithoutSpread) {
  const std::vector<std::vector<double>> line = {{1, 2}, {2, 4}, {3, 6}, {4, 8}, {5, 10}};
  EXPECT_TRUE(ContainmentOf(line, PointScatterOf(line), {0.95}).empty());
  const std::vector<std::vector<double>> flat = {{1, 2}, {2, 2}, {3, 2}, {4, 2}};
  EXPECT_TRUE(ContainmentOf(flat, PointScatterOf(flat), {0.95}).empty());
  const std::vector<std::vector<double>> few = {{1, 2}, {2, 5}, {3, 1}};
  EXPECT_TRUE(ContainmentOf(few, PointScatterOf(few), {0.95}).empty());
}

// Of points in any direction: turned back by its angle, the ellipse's axes are the points' covariance, and
// every point of its outline is as far away in units of that covariance. The outline runs counterclockwise,
// as GeoJSON asks of a ring.
TEST(PointScatter, EllipsesHaveTheCovarianceOfTheirPoints) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Stream stream(seed, 0, "made up");
    std::vector<std::vector<double>> points;
    const double tilt = stream.Uniform() * 6.28, stretch = 0.1 + 5.0 * stream.Uniform();
    for (int i = 0; i < 20; ++i) {
      const double x = stretch * stream.Normal(), y = stream.Normal();
      points.push_back(
          {7.0 + std::cos(tilt) * x - std::sin(tilt) * y, -3.0 + std::sin(tilt) * x + std::cos(tilt) * y});
    }
    const PointScatter scatter = PointScatterOf(points);
    const auto& C = scatter.covariance;
    constexpr double kScale = 5.99;
    const ScatterEllipse ellipse = EllipseOf(C, kScale);
    const double major = ellipse.semi_major * ellipse.semi_major / kScale;
    const double minor = ellipse.semi_minor * ellipse.semi_minor / kScale;
    const double c = std::cos(ellipse.angle_rad), s = std::sin(ellipse.angle_rad);
    const double rounding = 1e-12 * major;
    EXPECT_NEAR(c * c * major + s * s * minor, C[0][0], rounding) << seed;
    EXPECT_NEAR(c * s * (major - minor), C[0][1], rounding) << seed;
    EXPECT_NEAR(s * s * major + c * c * minor, C[1][1], rounding) << seed;
    EXPECT_GE(major, minor);
    const auto outline = OutlineOf(ellipse, {scatter.mean[0], scatter.mean[1]}, 36);
    const double determinant = C[0][0] * C[1][1] - C[0][1] * C[0][1];
    double twice_area = 0.0;
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
      const double x = outline[i][0] - scatter.mean[0], y = outline[i][1] - scatter.mean[1];
      EXPECT_NEAR((C[1][1] * x * x - 2.0 * C[0][1] * x * y + C[0][0] * y * y) / determinant, kScale, 1e-9)
          << seed;
      twice_area += outline[i][0] * outline[i + 1][1] - outline[i + 1][0] * outline[i][1];
    }
    // 36 corners leave 0.5 % of an ellipse's area out.
    EXPECT_NEAR(0.5 * twice_area, std::numbers::pi * ellipse.semi_major * ellipse.semi_minor,
                0.006 * std::numbers::pi * ellipse.semi_major * ellipse.semi_minor);
  }
}

// Five of five points inside: (1 - p)^5 = 2.5 % gives the lower limit of 95 %.
TEST(PointScatter, ContainmentHasTheLimitsOfItsCounts) {
  const std::vector<std::vector<double>> points = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0, 0}};
  const Containment all = ContainmentOf(points, PointScatterOf(points), {0.99}).at(0);
  EXPECT_EQ(all.inside, 5);
  EXPECT_NEAR(all.limits.lower, std::pow(0.025, 1.0 / 5.0), 1e-12);
  EXPECT_EQ(all.limits.upper, 1.0);
}

TEST(PointScatter, AxesAndOutline) {
  // Turned by 30 degrees, half-axes 5 and 2 at scale 1.
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  const std::vector<std::vector<double>> covariance = {{25 * c * c + 4 * s * s, 21 * c * s},
                                                       {21 * c * s, 25 * s * s + 4 * c * c}};
  const ScatterEllipse ellipse = EllipseOf(covariance, 4.0);
  EXPECT_NEAR(ellipse.semi_major, 10.0, 1e-12);
  EXPECT_NEAR(ellipse.semi_minor, 4.0, 1e-12);
  EXPECT_NEAR(ellipse.angle_rad, std::numbers::pi / 6, 1e-12);
  const auto outline = OutlineOf(ellipse, {1.0, 2.0}, 72);
  ASSERT_EQ(outline.size(), 73u);
  EXPECT_EQ(outline.front(), outline.back());
  EXPECT_NEAR(outline[0][0], 1.0 + 10.0 * c, 1e-12);
  EXPECT_NEAR(outline[0][1], 2.0 + 10.0 * s, 1e-12);
}

}  // namespace
}  // namespace dispersa::statistics_point_scatter_test
