// Impact points of known covariance, turned to every azimuth: their ellipses in GeoJSON and KML. Places are
// computed from the radii of curvature of the ellipsoid, which the product does not use.
#include <nlohmann/json.hpp>

#include "core/analysis/footprints.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_footprint_axes_test {
namespace {

using nlohmann::json;

constexpr double kLatitude_rad = 0.6, kLongitude_rad = 1.2;
constexpr double kAlong_m = 900.0, kAcross_m = 300.0;

/// WGS-84: of the meridian, and across it.
double MeridianRadius(double latitude_rad) {
  constexpr double a_m = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  return a_m * (1.0 - e2) / std::pow(1.0 - e2 * std::pow(std::sin(latitude_rad), 2), 1.5);
}
double NormalRadius(double latitude_rad) {
  constexpr double a_m = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  return a_m / std::sqrt(1.0 - e2 * std::pow(std::sin(latitude_rad), 2));
}

Geodetic PlaceAt(double north_m, double east_m) {
  const double latitude_rad = kLatitude_rad + north_m / MeridianRadius(kLatitude_rad);
  return {latitude_rad, kLongitude_rad + east_m / (NormalRadius(latitude_rad) * std::cos(latitude_rad)), 0.0};
}
/// North and east of the middle, m, from a GeoJSON position.
std::array<double, 2> NorthEast(const json& position) {
  const double latitude_rad = position[1].get<double>() * kRadPerDeg;
  const double longitude_rad = position[0].get<double>() * kRadPerDeg;
  return {(latitude_rad - kLatitude_rad) * MeridianRadius(kLatitude_rad),
          (longitude_rad - kLongitude_rad) * NormalRadius(latitude_rad) * std::cos(latitude_rad)};
}

/// Four points, two on each axis: the variance along an axis is 2/3 of the square of their distance.
std::vector<ImpactPoint> Cross(double azimuth_deg) {
  std::vector<ImpactPoint> points;
  const double c = std::cos(azimuth_deg * kRadPerDeg), s = std::sin(azimuth_deg * kRadPerDeg);
  for (const auto& [along_m, across_m] : std::vector<std::array<double, 2>>{
           {kAlong_m, 0.0}, {-kAlong_m, 0.0}, {0.0, kAcross_m}, {0.0, -kAcross_m}}) {
    ImpactPoint point;
    point.case_index = points.size();
    point.stage = 1;
    point.impact = Impact{};
    point.impact->place = PlaceAt(along_m * c - across_m * s, along_m * s + across_m * c);
    points.push_back(point);
  }
  ImpactPoint aloft;  // counts, and moves nothing
  aloft.case_index = points.size();
  aloft.stage = 1;
  points.push_back(aloft);
  return points;
}

class FootprintAzimuths : public testing::TestWithParam<int> {};

TEST_P(FootprintAzimuths, AreClockwiseFromNorthWithAxesInKilometres) {
  const double azimuth_deg = GetParam();
  const json all = json::parse(GeoJson(report_test::MakeCampaign(5), GatherFootprints(Cross(azimuth_deg))));
  std::size_t ellipses = 0;
  for (const json& feature : all["features"]) {
    const json& properties = feature["properties"];
    if (properties["kind"] != "footprint") continue;
    ++ellipses;
    const double stated = properties["stated_containment"];
    const double scale = std::sqrt(-2.0 * std::log(1.0 - stated) * 2.0 / 3.0);
    // Positions are rounded to a centimetre, and the plane bends away by a 10^7th: one in 10^4 is enough for
    // both.
    EXPECT_NEAR(properties["semi_major_km"], 0.9 * scale, 1e-4 * scale);
    EXPECT_NEAR(properties["semi_minor_km"], 0.3 * scale, 1e-4 * scale);
    const double found_deg = properties["azimuth_deg"];
    EXPECT_GE(found_deg, 0.0);
    EXPECT_LT(found_deg, 180.0);
    EXPECT_NEAR(std::remainder(found_deg - azimuth_deg, 180.0), 0.0, 0.01);
    EXPECT_NEAR(NorthEast(properties["mean"])[0], 0.0, 0.1);
    EXPECT_NEAR(NorthEast(properties["mean"])[1], 0.0, 0.1);
    EXPECT_EQ(properties["points"], 4);
    EXPECT_EQ(properties["aloft"], 1);
    // All four points have the same distance in units of the covariance: 1.5, between 50 % and 95 %.
    EXPECT_EQ(properties["inside"], stated < 0.6 ? 0 : 4);
    const double c = std::cos(azimuth_deg * kRadPerDeg), s = std::sin(azimuth_deg * kRadPerDeg);
    double twice_area = 0.0;
    std::array<double, 2> last = NorthEast(feature["geometry"]["coordinates"][0].back());
    for (const json& position : feature["geometry"]["coordinates"][0]) {
      const auto [north_m, east_m] = NorthEast(position);
      const double along = (c * north_m + s * east_m) / (kAlong_m * scale);
      const double across = (-s * north_m + c * east_m) / (kAcross_m * scale);
      EXPECT_NEAR(along * along + across * across, 1.0, 1e-3);
      twice_area += last[1] * north_m - east_m * last[0];
      last = {north_m, east_m};
    }
    EXPECT_GT(twice_area, 0.0) << "an outer ring runs counterclockwise (RFC 7946, 3.1.6)";
  }
  EXPECT_EQ(ellipses, kFootprintContainment.size());
}

INSTANTIATE_TEST_SUITE_P(Each, FootprintAzimuths, testing::Values(0, 15, 45, 80, 90, 100, 135, 179));

/// One body that was lost and one that was spent, each number another.
std::vector<ImpactPoint> LostAndSpent() {
  ImpactPoint lost;
  lost.case_index = 7;
  lost.stage = 2;
  lost.lost = true;
  lost.from_time_s = 31.5;
  lost.from_altitude_m = 12'300.0;
  lost.impact = Impact{};
  lost.impact->place = PlaceAt(0.0, 0.0);
  lost.impact->time_s = 154.25;
  lost.impact->speed_m_s = 88.0;
  lost.impact->peak_altitude_m = 14'700.0;
  ImpactPoint spent = lost;
  spent.case_index = 8;
  spent.lost = false;
  return {lost, spent};
}

TEST(Footprints, StateWhatEachBodyDid) {
  const json all = json::parse(GeoJson(report_test::MakeCampaign(9), GatherFootprints(LostAndSpent())));
  ASSERT_EQ(all["features"].size(), 2u);
  const json& spent = all["features"][0]["properties"];
  EXPECT_EQ(spent["body"], "spent_stage");
  EXPECT_EQ(spent["case_index"], 8);
  const json& lost = all["features"][1]["properties"];
  EXPECT_EQ(lost["kind"], "impact");
  EXPECT_EQ(lost["body"], "lost_flight");
  EXPECT_EQ(lost["stage"], 2);
  EXPECT_EQ(lost["case_index"], 7);
  EXPECT_EQ(lost["from_time_s"], 31.5);
  EXPECT_DOUBLE_EQ(lost["from_altitude_km"], 12.3);
  EXPECT_EQ(lost["time_s"], 154.25);
  EXPECT_EQ(lost["speed_m_s"], 88.0);
  EXPECT_DOUBLE_EQ(lost["peak_altitude_km"], 14.7);
  EXPECT_EQ(lost["replay"], "dispersa replay . --case 7");
  const json& position = all["features"][1]["geometry"]["coordinates"];
  EXPECT_NEAR(position[0], kLongitude_rad * kDegPerRad, 1e-7);
  EXPECT_NEAR(position[1], kLatitude_rad * kDegPerRad, 1e-7);
}

TEST(Footprints, KmlMarksLostBodiesAsLost) {
  const std::string kml = Kml(report_test::MakeCampaign(9), GatherFootprints(LostAndSpent()));
  EXPECT_THAT(kml, testing::HasSubstr(
                       "<name>case 7</name><description>dispersa replay . --case 7; from 12.3 km at 31.50 "
                       "s, down at 154.2 s with 88 m/s</description><styleUrl>#lost</styleUrl>"));
  EXPECT_THAT(kml,
              testing::HasSubstr("#spent</styleUrl><Point><coordinates>68.7549354,34.3774677</coordinates>"));
}

}  // namespace
}  // namespace dispersa::analysis_footprint_axes_test
