#include "core/analysis/footprints.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/math/constants.h"
#include "core/random/draws.h"
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

TEST(Footprints, GeoJsonAcrossTheDateLine) {
  const auto json =
      nlohmann::json::parse(GeoJson(report_test::MakeCampaign(40), GatherFootprints(Scattered(179.95, 40))));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), 43u);  // three ellipses and forty points
  double west = 360.0, east = -360.0;
  for (const auto& feature : json["features"]) {
    EXPECT_EQ(feature["type"], "Feature");
    const auto& coordinates = feature["geometry"]["coordinates"];
    if (feature["geometry"]["type"] == "Polygon") {
      EXPECT_EQ(coordinates[0].front(), coordinates[0].back());  // a ring is closed
      EXPECT_EQ(feature["properties"]["points"], 40);
    } else {
      west = std::min(west, coordinates[0].get<double>());
      east = std::max(east, coordinates[0].get<double>());
    }
  }
  EXPECT_LT(east - west, 2.0);  // no line around the Earth
  EXPECT_GT(east, 180.0);
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
