// The plane of a map, and the window of it that is drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math/linear.h"

namespace dispersa {

struct MapPlace {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;  ///< any number of turns
};
using MapPoint = std::array<double, 2>;  ///< km east and north of the middle

/// Azimuthal equidistant about a place (J. P. Snyder, Map Projections, USGS Professional Paper 1395, 1987, p.
/// 191), on a sphere of the Earth's mean radius.
class MapPlane {
 public:
  /// About the middle of the places: the direction of the sum of their directions.
  explicit MapPlane(const std::vector<MapPlace>& places);

  /// None near the antipode of the middle, which lies in all directions.
  std::optional<MapPoint> At(const MapPlace& place) const;

  /// Whether a parallel may come so near to the middle.
  bool MeetsParallel(double latitude_deg, double radius_km) const;
  /// The same of a meridian, or of the one that goes on beyond the pole.
  bool MeetsMeridian(double longitude_deg, double radius_km) const;

 private:
  Vector3 east_ = Vector3::Zero(), north_ = Vector3::Zero(), up_ = Vector3::Zero();
};

/// The part of a plane that a picture shows, with one scale for both directions.
class MapWindow {
 public:
  /// All the points, with a margin, in a picture of this width; it is at most `most_px` high.
  MapWindow(const std::vector<MapPoint>& points, double width_px, double most_px);

  double width_px() const { return width_px_; }
  double height_px() const { return height_px_; }
  double px_per_km() const { return px_per_km_; }
  /// Of the picture's farthest corner from the middle of the plane.
  double farthest_km() const;
  MapPoint Pixel(const MapPoint& point) const;
  /// The part of a segment inside the picture, in pixels (Y.-D. Liang and B. A. Barsky, ACM Trans. Graphics 3
  /// (1984) 1).
  std::optional<std::array<MapPoint, 2>> Inside(const MapPoint& from, const MapPoint& to) const;

 private:
  double width_px_;
  double height_px_ = 0.0;
  double px_per_km_ = 1.0;
  MapPoint middle_ = {0.0, 0.0};
};

/// The SVG path of the parts of a line inside the window.
std::string MapPath(const MapPlane& plane, const MapWindow& window, const std::vector<MapPlace>& line);

/// The corners of the smallest convex polygon around the points, anticlockwise (A. M. Andrew, Inf. Process.
/// Lett. 9 (1979) 216).
std::vector<MapPoint> ConvexHull(std::vector<MapPoint> points);

/// The coast lines of coast_lines.txt.
std::vector<std::vector<MapPlace>> CoastLines();

}  // namespace dispersa
