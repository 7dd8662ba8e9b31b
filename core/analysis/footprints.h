// Impact points of a campaign as footprints, KML and GeoJSON.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/impact/impact_points.h"
#include "core/results/result_folder.h"
#include "core/statistics/point_scatter.h"

namespace dispersa {

/// Where the bodies of one kind come down.
struct Footprint {
  int stage = 0;                    ///< 1-based
  bool lost = false;                ///< stacks of lost flights, else spent stages
  std::vector<ImpactPoint> points;  ///< in the order of cases, those that came down
  std::size_t aloft = 0;            ///< that did not
  Geodetic mean{};                  ///< of the points, on the ellipsoid
  PointScatter scatter;             ///< east and north of the mean, m, in the plane that touches there
  std::vector<Containment> containment;
  std::vector<ScatterEllipse> ellipses;  ///< one a containment: angle from east to north
  std::vector<std::vector<Geodetic>> outlines;
};

inline constexpr std::array<double, 3> kFootprintContainment = {0.5, 0.95, 0.99};

/// Flies every case that has a result again, checks that it comes out the same, and gathers what came down:
/// spent stages by stage, then lost flights by stage. InputError when another engine flew the folder,
/// ResultError when a case does not reproduce. `progress(done, total)` is called one at a time and may throw
/// to stop.
std::vector<Footprint> FootprintsOf(const ResultFolder& folder, const Campaign& campaign, int threads,
                                    const std::function<void(std::size_t, std::size_t)>& progress = {});
/// Of points that are given.
std::vector<Footprint> GatherFootprints(const std::vector<ImpactPoint>& points);

/// "stage 2, spent", "stack from stage 1, lost".
std::string FootprintTitle(const Footprint& footprint);

/// RFC 7946: a point an impact, a polygon an ellipse; longitudes go on beyond 180° where a footprint crosses
/// it.
std::string GeoJson(const Campaign& campaign, const std::vector<Footprint>& footprints);
/// OGC KML 2.2: a folder a footprint.
std::string Kml(const Campaign& campaign, const std::vector<Footprint>& footprints);

}  // namespace dispersa
