// Maps: places on the plane, what the window shows, and coast lines.
#include "core/pages/ground_map.h"

#include "core/campaign_yaml/sha256.h"
#include "core/pages/embedded.h"
#include "core/pages/kept_histories.h"
#include "core/pages/map_plane.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::pages_ground_map_test {
namespace {

constexpr double kQuarter_km = 6371.0088 * 0.5 * 3.14159265358979;

double Away_km(const MapPlane& plane, const MapPlace& a, const MapPlace& b) {
  const MapPoint from = *plane.At(a), to = *plane.At(b);
  return std::hypot(to[0] - from[0], to[1] - from[1]);
}

// The middle is at the origin; north is up and east to the right in both hemispheres and on both sides of
// 180.
TEST(MapPlane, KeepsDistancesAndDirectionsFromItsMiddle) {
  for (const double latitude_deg : {5.0, -39.0, 62.0})
    for (const double longitude_deg : {-52.0, 0.0, 180.0, 177.0}) {
      const MapPlane plane({{latitude_deg, longitude_deg}});
      const MapPoint north = *plane.At({latitude_deg + 1.0, longitude_deg});
      const MapPoint east = *plane.At({latitude_deg, longitude_deg + 0.1});
      EXPECT_NEAR(north[0], 0.0, 1e-6);
      EXPECT_NEAR(north[1], kQuarter_km / 90.0, 1e-6);
      EXPECT_NEAR(east[0], 0.1 * kQuarter_km / 90.0 * std::cos(latitude_deg / 57.29577951308232), 0.01);
      EXPECT_NEAR(east[1], 0.0, 0.02);
    }
  EXPECT_FALSE(MapPlane({{10.0, 20.0}}).At({-10.0, 200.0})) << "the antipode lies in all directions";
}

TEST(MapPlane, HasNoEdgeAt180DegreesNorAtAPole) {
  const MapPlane pacific({{-10.0, 179.0}, {-10.0, -179.0}});
  EXPECT_NEAR(Away_km(pacific, {-10.0, 179.5}, {-10.0, -179.5}), 0.985 * kQuarter_km / 90.0, 0.1);
  const MapPlane arctic({{89.0, 30.0}, {89.0, -150.0}});
  EXPECT_NEAR(Away_km(arctic, {89.0, 30.0}, {89.0, -150.0}), 2.0 * kQuarter_km / 90.0, 1e-3);
}

TEST(MapPlane, KnowsParallelsAndMeridiansThatDoNotComeNear) {
  const MapPlane plane({{10.0, 179.0}});
  constexpr double kRadius_km = 112.0;  // a degree is 111.2 km
  EXPECT_TRUE(plane.MeetsParallel(11.0, kRadius_km));
  EXPECT_FALSE(plane.MeetsParallel(11.1, kRadius_km));
  EXPECT_TRUE(plane.MeetsMeridian(-180.0, kRadius_km));
  EXPECT_FALSE(plane.MeetsMeridian(-178.0, kRadius_km));
  EXPECT_TRUE(plane.MeetsMeridian(77.0, 12000.0)) << "beyond the pole";
}

TEST(MapWindow, ShowsAllWithOneScaleAndCutsWhatLeavesIt) {
  const MapWindow window({{-100.0, -20.0}, {300.0, 20.0}}, 1000.0, 600.0);
  const MapPoint west = window.Pixel({-100.0, -20.0}), east = window.Pixel({300.0, 20.0});
  EXPECT_GT(west[0], 0.0);
  EXPECT_LT(east[0], window.width_px());
  EXPECT_GT(west[1], east[1]) << "north is up";
  EXPECT_NEAR((east[0] - west[0]) / 400.0, (west[1] - east[1]) / 40.0, 1e-9);
  const auto through = window.Inside({-5000.0, 0.0}, {5000.0, 0.0});
  ASSERT_TRUE(through);
  EXPECT_NEAR((*through)[0][0], 0.0, 1e-6);
  EXPECT_NEAR((*through)[1][0], window.width_px(), 1e-6);
  EXPECT_FALSE(window.Inside({-5000.0, 900.0}, {5000.0, 900.0}));
  EXPECT_FALSE(window.Inside({-5000.0, -900.0}, {-900.0, 900.0})) << "it goes round the corner";
  // Tall, as a flight to the north.
  const MapWindow tall({{0.0, 0.0}, {10.0, 4000.0}}, 1000.0, 600.0);
  EXPECT_EQ(tall.height_px(), 600.0);
  EXPECT_GT(tall.Pixel({0.0, 4000.0})[1], 0.0);
  EXPECT_LT(tall.Pixel({0.0, 0.0})[1], 600.0);
}

TEST(ConvexHull, LeavesOutWhatIsInside) {
  const std::vector<MapPoint> hull = ConvexHull({{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 0}});
  EXPECT_EQ(hull.size(), 4u);
  for (const MapPoint& inside : {MapPoint{1, 1}, MapPoint{1, 0}})
    EXPECT_EQ(std::count(hull.begin(), hull.end(), inside), 0);
}

TEST(CoastLines, AreTheLinesThatTheirHeaderNames) {
  const std::string text(CoastLineData());
  const std::string title = "# SHA-256 of the lines below: ";
  const std::size_t at = text.find(title), after = text.find("\n", text.find("# A line: "));
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(Sha256Hex(std::string_view(text).substr(after + 1)), text.substr(at + title.size(), 64));
}

// Well-known capes, to the 20 km of this scale; no line crosses the map along the antimeridian.
TEST(CoastLines, PassTheCapes) {
  const auto lines = CoastLines();
  EXPECT_GT(lines.size(), 100u);
  for (const MapPlace& cape : {MapPlace{-55.6, -67.9}, MapPlace{-34.6, 19.6}, MapPlace{36.1, -5.5}}) {
    const MapPlane plane({cape});
    double nearest_km = HUGE_VAL;
    for (const auto& line : lines)
      for (const MapPlace& place : line)
        if (const auto point = plane.At(place))
          nearest_km = std::min(nearest_km, std::hypot((*point)[0], (*point)[1]));
    EXPECT_LT(nearest_km, 80.0) << cape.latitude_deg;
  }
  for (const auto& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      EXPECT_LT(std::fabs(line[i].longitude_deg - line[i - 1].longitude_deg), 180.0);
      EXPECT_FALSE(std::fabs(line[i].longitude_deg) == 180.0 &&
                   std::fabs(line[i - 1].longitude_deg) == 180.0);
      EXPECT_LE(std::fabs(line[i].latitude_deg), 90.0);
    }
}

/// A track of 100 s over `north_deg` and `east_deg`.
History Track(double latitude_deg, double longitude_deg, double north_deg, double east_deg) {
  History history;
  for (int k = 0; k <= 100; ++k) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    const auto set = [&](const char* name, double value) {
      row[static_cast<std::size_t>(FindHistoryColumn(name))] = value;
    };
    set("time_s", k);
    set("latitude_deg", latitude_deg + 0.01 * k * north_deg);
    set("longitude_deg", NearTo(0.0, longitude_deg + 0.01 * k * east_deg, kCutAt180Deg));
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  return history;
}

FlightHistories Flown(const std::vector<History>& flights) {
  FlightHistories histories;
  histories.nominal_history = flights[0];
  std::vector<SampledFlight> sampled;
  const std::vector<int> columns = {FindHistoryColumn("latitude_deg"), FindHistoryColumn("longitude_deg")};
  for (const History& flight : flights) sampled.push_back(SampleFlight(flight, columns, 1.0));
  histories.bands = ComputeBands(sampled, columns, 1.0);
  return histories;
}

/// The points of a path of this class.
std::vector<MapPoint> PathOf(const std::string& html, const std::string& style) {
  const std::size_t path = html.find("class=\"" + style + "\"");
  if (path == std::string::npos) return {};
  const std::size_t begin = html.find("d=\"", path) + 3;
  const std::string d = html.substr(begin, html.find('"', begin) - begin);
  static const std::regex point("([0-9.-]+) ([0-9.-]+)");
  std::vector<MapPoint> points;
  for (std::sregex_iterator at(d.begin(), d.end(), point), end; at != end; ++at)
    points.push_back({std::stod((*at)[1]), std::stod((*at)[2])});
  return points;
}

TEST(MapFigure, DrawsTheTrackInOnePieceAtAnyAzimuthAndPlace) {
  for (const auto& [latitude_deg, longitude_deg] :
       {std::pair{5.2, -52.8}, {-39.3, 177.9}, {28.5, -179.9}, {-75.0, 0.0}, {69.3, 16.0}})
    for (const auto& [north_deg, east_deg] :
         {std::pair{0.0, 20.0}, {0.0, -20.0}, {14.0, 3.0}, {-14.0, -3.0}, {10.0, 15.0}}) {
      const std::string html =
          MapFigure({},
                    Flown({Track(latitude_deg, longitude_deg, north_deg, east_deg),
                           Track(latitude_deg, longitude_deg, north_deg + 0.4, east_deg + 0.4)}),
                    {});
      const std::vector<MapPoint> track = PathOf(html, "line-1");
      ASSERT_GT(track.size(), 90u);
      double longest_px = 0.0;
      for (std::size_t i = 1; i < track.size(); ++i)
        longest_px =
            std::max(longest_px, std::hypot(track[i][0] - track[i - 1][0], track[i][1] - track[i - 1][1]));
      EXPECT_LT(longest_px, 40.0) << latitude_deg << " " << longitude_deg << ": it jumps";
      if (north_deg == 0.0) {
        EXPECT_EQ(track.back()[0] > track.front()[0], east_deg > 0.0);
      }
      if (std::fabs(north_deg) > 10.0) {
        EXPECT_EQ(track.back()[1]<track.front()[1], north_deg> 0.0);
      }
      EXPECT_FALSE(PathOf(html, "cover").empty());
      EXPECT_FALSE(PathOf(html, "grid").empty());
    }
}

TEST(MapFigure, ShowsWhatFallsWithItsEllipses) {
  FlightHistories histories = Flown({Track(5.0, -52.0, 3.0, 20.0)});
  std::vector<ImpactPoint> impacts;
  for (std::uint64_t k = 0; k < 12; ++k) {
    const double east_rad = 0.001 * static_cast<double>(k % 4),
                 north_rad = 0.0007 * static_cast<double>(k % 3);
    impacts.push_back({.case_index = k,
                       .stage = 1,
                       .lost = false,
                       .impact = Impact{.place = {0.1 + north_rad, -0.85 + east_rad, 0.0}}});
    impacts.push_back({.case_index = k, .stage = 2, .lost = false});
  }
  const std::string html = MapFigure({}, histories, GatherFootprints(impacts));
  EXPECT_EQ(PathOf(html, "dots").size(), 12u);
  EXPECT_FALSE(PathOf(html, "ellipse").empty());
  EXPECT_THAT(html, HasSubstr(">stage 1, spent</text>"));
  EXPECT_THAT(html, HasSubstr(">stage 2, spent</th><td class=\"n\">0</td><td class=\"n\">12</td>"));
  EXPECT_EQ(MapFigure({}, {}, {}), "") << "nothing was flown again";
}

TEST(Impacts, AreReadAsTheyWereWritten) {
  const ImpactPoint points[] = {
      {.case_index = 3, .stage = 0, .impact = Impact{.place = {0.5, -3.0, 0.0}}},
      {.case_index = 4, .stage = 2, .lost = true, .impact = Impact{.place = {-1.25, 2.0, 0.0}}},
      {.case_index = 5, .stage = 3}};
  const std::vector<ImpactPoint> read = ImpactsIn(ImpactsCsv({std::begin(points), std::end(points)}));
  ASSERT_EQ(read.size(), std::size(points));
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].case_index, points[i].case_index);
    EXPECT_EQ(read[i].stage, points[i].stage);
    EXPECT_EQ(read[i].lost, points[i].lost);
    ASSERT_EQ(read[i].impact.has_value(), points[i].impact.has_value());
    if (!read[i].impact) continue;
    EXPECT_NEAR(read[i].impact->place.latitude_rad, points[i].impact->place.latitude_rad, 1e-8);
    EXPECT_NEAR(read[i].impact->place.longitude_rad, points[i].impact->place.longitude_rad, 1e-8);
  }
  EXPECT_TRUE(ImpactsIn(ImpactsCsv({})).empty());
}

}  // namespace
}  // namespace dispersa::pages_ground_map_test
