#include "core/analysis/footprints.h"

#include <nlohmann/json.hpp>

#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_footprints_test {
namespace {

/// Impacts about a place: 20 km of spread to the east, 5 km to the north, not correlated.
std::vector<ImpactPoint> Scattered(double longitude_deg, int count) {
  const Earth earth = Wgs84();
  const Geodetic mean{0.3, longitude_deg * kRadPerDeg, 0.0};
  const Matrix3 axes = NedAxes(mean.latitude_rad, mean.longitude_rad);
  std::vector<ImpactPoint> points;
  for (int i = 0; i < count; ++i) {
    Stream stream(5, static_cast<std::uint64_t>(i), "impact");
    const double east_m = 20e3 * stream.Normal(), north_m = 5e3 * stream.Normal();
    ImpactPoint point;
    point.case_index = static_cast<std::uint64_t>(i);
    point.stage = 2;
    point.impact = Impact{};
    point.impact->place =
        ToGeodetic(earth, FromGeodetic(earth, mean) + east_m * axes.col(1) + north_m * axes.col(0));
    point.impact->place.altitude_m = 0.0;
    points.push_back(point);
  }
  return points;
}

TEST(Footprints, FindTheSpreadOfTheirPoints) {
  std::vector<ImpactPoint> points = Scattered(70.0, 2000);
  ImpactPoint aloft;
  aloft.stage = 2;
  points.push_back(aloft);
  const std::vector<Footprint> footprints = GatherFootprints(points);
  ASSERT_EQ(footprints.size(), 1u);
  const Footprint& footprint = footprints[0];
  EXPECT_EQ(FootprintTitle(footprint), "stage 2, spent");
  EXPECT_EQ(footprint.aloft, 1u);
  EXPECT_NEAR(footprint.mean.longitude_rad * kDegPerRad, 70.0, 0.02);
  ASSERT_EQ(footprint.containment.size(), 3u);
  const double scale = std::sqrt(-2.0 * std::log(0.05));
  // Four standard errors of a deviation from 2000 points: 6 %.
  EXPECT_NEAR(footprint.ellipses[1].semi_major, 20e3 * scale, 0.06 * 20e3 * scale);
  EXPECT_NEAR(footprint.ellipses[1].semi_minor, 5e3 * scale, 0.06 * 5e3 * scale);
  EXPECT_NEAR(footprint.ellipses[1].angle_rad, 0.0, 0.02);
  EXPECT_NEAR(footprint.containment[1].empirical, 0.95, 0.02);
}

/// Twice the area of a ring in square degrees; positive if it runs counter-clockwise.
double TwiceArea(const nlohmann::json& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    sum += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
           ring[i + 1][0].get<double>() * ring[i][1].get<double>();
  return sum;
}

// RFC 7946, section 3.1.9: what crosses the antimeridian is cut there. On either side of it, and away from
// it.
TEST(Footprints, GeoJsonIsCutAtTheAntimeridian) {
  double uncut = 0.0;
  for (const double site_deg : {70.0, 179.95, -179.95}) {
    SCOPED_TRACE(site_deg);
    const auto json = nlohmann::json::parse(
        GeoJson(report_test::MakeCampaign(40), GatherFootprints(Scattered(site_deg, 40))));
    ASSERT_EQ(json["features"].size(), 43u);  // three ellipses and forty points
    double area = 0.0;
    for (const auto& feature : json["features"]) {
      const auto& geometry = feature["geometry"];
      if (geometry["type"] == "Point") {
        EXPECT_LE(std::fabs(geometry["coordinates"][0].get<double>()), 180.0);
        continue;
      }
      EXPECT_EQ(geometry["type"], site_deg == 70.0 ? "Polygon" : "MultiPolygon");
      nlohmann::json polygons = geometry["coordinates"];
      if (site_deg == 70.0) polygons = nlohmann::json::array({polygons});
      EXPECT_EQ(polygons.size(), site_deg == 70.0 ? 1u : 2u);
      double of_one = 0.0;
      for (const auto& polygon : polygons) {
        const auto& ring = polygon[0];
        EXPECT_EQ(ring.front(), ring.back());
        double west = 360.0, east = -360.0;
        for (const auto& place : ring) {
          west = std::min(west, place[0].get<double>());
          east = std::max(east, place[0].get<double>());
        }
        EXPECT_GE(west, -180.0);
        EXPECT_LE(east, 180.0);
        EXPECT_TRUE(site_deg == 70.0 || west == -180.0 || east == 180.0);
        EXPECT_LT(east - west, 5.0);  // no line around the Earth
        EXPECT_GT(TwiceArea(ring), 0.0);
        of_one += TwiceArea(ring);
      }
      area += of_one;
    }
    if (site_deg == 70.0) uncut = area;
    EXPECT_NEAR(area, uncut, 1e-3 * uncut);  // the pieces are the whole
  }
}

TEST(Footprints, AroundThePoleRunToThePole) {
  std::vector<ImpactPoint> points;
  for (int i = 0; i < 40; ++i) {
    ImpactPoint point{.case_index = static_cast<std::uint64_t>(i), .stage = 1};
    point.impact = Impact{};
    point.impact->place = {(89.0 + 0.01 * (i % 7)) * kRadPerDeg, (9.0 * i - 180.0) * kRadPerDeg, 0.0};
    points.push_back(point);
  }
  const auto json = nlohmann::json::parse(GeoJson(report_test::MakeCampaign(40), GatherFootprints(points)));
  const auto& geometry = json["features"][0]["geometry"];
  double north = 0.0, west = 360.0, east = -360.0;
  ASSERT_TRUE(geometry["type"] == "Polygon" || geometry["type"] == "MultiPolygon");
  const nlohmann::json polygons = geometry["type"] == "Polygon"
                                      ? nlohmann::json::array({geometry["coordinates"]})
                                      : geometry["coordinates"];
  for (const auto& polygon : polygons)
    for (const auto& place : polygon[0]) {
      west = std::min(west, place[0].get<double>());
      east = std::max(east, place[0].get<double>());
      north = std::max(north, place[1].get<double>());
    }
  EXPECT_EQ(north, 90.0);
  EXPECT_EQ(west, -180.0);
  EXPECT_EQ(east, 180.0);
}

TEST(Footprints, KmlIsCutAtTheAntimeridian) {
  const std::string kml = Kml(report_test::MakeCampaign(40), GatherFootprints(Scattered(179.95, 40)));
  EXPECT_THAT(kml, testing::HasSubstr("<MultiGeometry><Polygon>"));
  EXPECT_THAT(kml, testing::HasSubstr("</Polygon><Polygon>"));
  EXPECT_THAT(kml, testing::HasSubstr("-180.0000000,"));
  EXPECT_THAT(kml, testing::Not(testing::ContainsRegex("18[1-9]\\.|180\\.[0-9]*[1-9],")));
}

TEST(Footprints, KmlHasAFolderEach) {
  const std::string kml = Kml(report_test::MakeCampaign(40), GatherFootprints(Scattered(70.0, 40)));
  EXPECT_THAT(kml, testing::HasSubstr("<Folder><name>stage 2, spent</name>"));
  EXPECT_THAT(kml, testing::HasSubstr("dispersa replay . --case 39"));
  EXPECT_THAT(kml, testing::Not(testing::HasSubstr("nan")));
}

TEST(Footprints, OfOnePointHaveNoEllipse) {
  const std::vector<Footprint> footprints = GatherFootprints(Scattered(70.0, 1));
  EXPECT_TRUE(footprints[0].ellipses.empty());
  EXPECT_TRUE(GatherFootprints({}).empty());
}

}  // namespace
}  // namespace dispersa::analysis_footprints_test
