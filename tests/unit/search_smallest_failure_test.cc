// The bounded search: on limits whose nearest point is known, and on flights with a planted cause.
#include "core/search/smallest_failure.h"

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::search_smallest_failure_test {

using Point = std::vector<double>;

std::vector<Coordinate> Normals(int count) {
  std::vector<Coordinate> coordinates;
  for (int i = 0; i < count; ++i) coordinates.push_back({"x" + std::to_string(i), CoordinateKind::kNormal});
  return coordinates;
}

/// One margin a point, counted.
struct Counted {
  std::function<double(const Point&)> margin;
  std::size_t flights = 0;

  PointMargins At() {
    return [this](const std::vector<Point>& points) {
      flights += points.size();
      std::vector<double> margins;
      for (const Point& point : points) margins.push_back(margin(point));
      return margins;
    };
  }
};

TEST(SmallestFailure, OfAPlaneIsTheFootOfItsPerpendicular) {
  // 3 - (x1 + 2 x4 - 2 x7) / 3: at a distance of 3.
  Counted plane{[](const Point& x) { return 3.0 - (x[1] + 2.0 * x[4] - 2.0 * x[7]) / 3.0; }};
  const FailureSearchResult found = FindSmallestFailure(Normals(10), plane.At(), {});
  ASSERT_TRUE(found.found);
  EXPECT_LE(found.margin, 0.0);
  EXPECT_GE(found.distance, 3.0);
  EXPECT_LT(found.distance, 3.03);
  EXPECT_NEAR(found.point[1], 1.0, 0.1);
  EXPECT_NEAR(found.point[4], 2.0, 0.1);
  EXPECT_NEAR(found.point[7], -2.0, 0.1);
  EXPECT_NEAR(found.point[0], 0.0, 0.05);
}

TEST(SmallestFailure, OfABentLimit) {
  // Outside a parabola, nearest at (2, 0): x0 - 2 - x1^2 / 4 bends away from zero.
  Counted bent{[](const Point& x) { return 2.0 + 0.25 * x[1] * x[1] - x[0]; }};
  const FailureSearchResult found = FindSmallestFailure(Normals(5), bent.At(), {});
  ASSERT_TRUE(found.found);
  EXPECT_GE(found.distance, 2.0);
  EXPECT_LT(found.distance, 2.02);
}

TEST(SmallestFailure, KeepsOnlyWhatTheFailureNeeds) {
  // Lost without a slope to follow beyond |x3| = 2.5: one cause among thirty.
  Counted cliff{[](const Point& x) { return std::fabs(x[3]) > 2.5 ? std::nan("") : 1.0; }};
  const FailureSearchResult found = FindSmallestFailure(Normals(30), cliff.At(), {});
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(found.distance, 2.5, 0.02);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_TRUE(i == 3 || found.point[i] == 0.0) << i;
}

TEST(SmallestFailure, DirectionsAddNoDistance) {
  // The magnitude x0 fails above 2 / cos of the angle between the direction and 1 rad.
  std::vector<Coordinate> coordinates = {{"magnitude", CoordinateKind::kNormal},
                                         {"clock", CoordinateKind::kDirection}};
  Counted turned{[](const Point& x) {
    const double angle = 2.0 * kPi * 0.5 * std::erfc(-x[1] / std::sqrt(2.0));
    return 2.0 - std::fabs(x[0]) * std::cos(angle - 1.0);
  }};
  const FailureSearchResult found = FindSmallestFailure(coordinates, turned.At(), {});
  ASSERT_TRUE(found.found);
  EXPECT_LT(found.distance, 2.05);
  EXPECT_EQ(DistanceOf(coordinates, {3.0, 99.0}), 3.0);
}

TEST(SmallestFailure, FollowsTheSlopeWhereNothingThatItTriesFails) {
  // At a distance of 5.5 along the diagonal of twelve coordinates: rare for any point that is drawn.
  Counted far{[](const Point& x) {
    double sum = 0.0;
    for (const double each : x) sum += each;
    return 5.5 - sum / std::sqrt(12.0);
  }};
  const FailureSearchResult found = FindSmallestFailure(Normals(12), far.At(), {});
  ASSERT_TRUE(found.found);
  EXPECT_GE(found.distance, 5.5);
  EXPECT_LT(found.distance, 5.55);
}

TEST(SmallestFailure, IsBoundedAndRepeatable) {
  for (const std::size_t flights : {20u, 57u, 300u}) {
    FailureSearchOptions options;
    options.max_flights = flights;
    Counted far{[](const Point& x) { return 3.5 - x[0] - 0.1 * x[1]; }};
    const FailureSearchResult once = FindSmallestFailure(Normals(8), far.At(), options);
    EXPECT_LE(far.flights, flights);
    EXPECT_EQ(once.flights, far.flights);
    const FailureSearchResult again = FindSmallestFailure(Normals(8), far.At(), options);
    EXPECT_EQ(once.point, again.point);
    EXPECT_EQ(once.found, again.found);
  }
}

TEST(SmallestFailure, NoneWithinReachAndTheNominal) {
  Counted safe{[](const Point& x) { return 20.0 - x[0]; }};
  const FailureSearchResult none = FindSmallestFailure(Normals(3), safe.At(), {});
  EXPECT_FALSE(none.found);
  EXPECT_GT(none.least_margin, 10.0);
  Counted nominal{[](const Point&) { return -1.0; }};
  const FailureSearchResult at_once = FindSmallestFailure(Normals(3), nominal.At(), {});
  EXPECT_TRUE(at_once.found);
  EXPECT_EQ(at_once.distance, 0.0);
  EXPECT_EQ(at_once.flights, 1u);
}

// A failure that is farther out than the search may go is none, though its points came across it.
TEST(SmallestFailure, BeyondItsReachIsNone) {
  FailureSearchOptions options;
  options.reach = 4.0;
  std::size_t failed = 0;
  Counted far{[&](const Point& x) {
    failed += std::fabs(x[0]) > 4.5;
    return 4.5 - std::fabs(x[0]);
  }};
  const FailureSearchResult found = FindSmallestFailure(Normals(8), far.At(), options);
  EXPECT_GT(failed, 0u) << "it came across none: this shows nothing";
  EXPECT_FALSE(found.found);
}

// A lost flight has no margin; the least one is that of those that have.
TEST(SmallestFailure, TheLeastMarginIsOfFlightsThatHaveOne) {
  Counted lost{[](const Point& x) { return x[0] > 2.5 ? std::nan("") : 1.0 + std::fabs(x[1]); }};
  const FailureSearchResult found = FindSmallestFailure(Normals(3), lost.At(), {});
  EXPECT_TRUE(found.found);
  EXPECT_EQ(found.least_margin, 1.0);
}

TEST(DispersionSpace, AppliesWhatTheLawsMean) {
  const Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/table3.yaml");
  const DispersionSpace space(campaign);
  Point point(space.coordinates().size(), 0.0);
  int directions = 0;
  std::size_t drag = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    directions += space.coordinates()[i].kind == CoordinateKind::kDirection;
    if (space.coordinates()[i].name.find("drag") != std::string::npos) drag = i;
  }
  EXPECT_EQ(directions, 5);  // four clock angles and the wind's azimuth
  point[drag] = -3.0;
  const FlightInputs inputs = space.Inputs({Point(point.size(), 0.0), point})[1];
  EXPECT_NEAR(inputs.drag_factor, 1.0 - 0.067, 1e-12);
  for (const StageInputs& stage : inputs.stages) {
    EXPECT_EQ(stage.thrust_factor, 1.0);
    EXPECT_EQ(stage.thrust.misalignment_rad.magnitude, 0.0);
  }
}

}  // namespace dispersa::search_smallest_failure_test
