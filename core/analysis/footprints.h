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

/// The impact area of the bodies of one kind.
struct Footprint {
  int stage = 0;                    ///< 1-based; 0: boosters
  bool lost = false;                ///< true: stacks of lost flights; false: spent stages and boosters
  std::vector<ImpactPoint> points;  ///< in the order of cases, without bodies that stayed aloft
  std::size_t aloft = 0;            ///< number of bodies that did not come down
  Geodetic mean{};                  ///< of the points, on the ellipsoid
  PointScatter scatter;             ///< east and north of the mean, m, in the plane tangent there
  std::vector<Containment> containment;
  std::vector<ScatterEllipse> ellipses;  ///< one a containment: angle from east to north
  std::vector<std::vector<Geodetic>> outlines;
};

inline constexpr std::array<double, 3> kFootprintContainment = {0.5, 0.95, 0.99};

/// Flies every case that has a result again, checks that the result is the same, and gathers the impact
/// points: boosters, spent stages by stage, then lost flights by stage. Throws InputError if another engine
/// flew the folder, and ResultError if a case does not reproduce. `progress(done, total)` is never called by
/// two threads at once; it may throw to stop.
std::vector<Footprint> FootprintsOf(const ResultFolder& folder, const Campaign& campaign, int threads,
                                    const std::function<void(std::size_t, std::size_t)>& progress = {});
/// The footprints of the given points.
std::vector<Footprint> GatherFootprints(const std::vector<ImpactPoint>& points);

/// "stage 2, spent", "boosters, spent", "stack from stage 1, lost".
std::string FootprintTitle(const Footprint& footprint);

/// GeoJSON (RFC 7946): a point for each impact, a polygon for each ellipse; several if it crosses the
/// antimeridian. `incomplete` is a member of the collection, if it is not empty.
std::string GeoJson(const Campaign& campaign, const std::vector<Footprint>& footprints,
                    const std::string& incomplete = "");
/// OGC KML 2.2: a folder for each footprint. `incomplete` is part of the description.
std::string Kml(const Campaign& campaign, const std::vector<Footprint>& footprints,
                const std::string& incomplete = "");

}  // namespace dispersa
