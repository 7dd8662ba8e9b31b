#include "core/pages/map_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/pages/embedded.h"

namespace dispersa {
namespace {

constexpr double kEarth_km = 6371.0088;  ///< mean radius, IUGG

Vector3 Outwards(const MapPlace& place) {
  const SinCos latitude = SineCosine(place.latitude_deg / kDegPerRad);
  const SinCos longitude = SineCosine(place.longitude_deg / kDegPerRad);
  return {latitude.cos * longitude.cos, latitude.cos * longitude.sin, latitude.sin};
}

std::string Number(double px) {
  const std::string text = fmt::format("{:.1f}", px + 0.0);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

}  // namespace

MapPlane::MapPlane(const std::vector<MapPlace>& places) {
  Vector3 sum = Vector3::Zero();
  for (const MapPlace& place : places) sum += Outwards(place);
  up_ = sum.norm() > 1e-9 ? Vector3(sum / sum.norm()) : Vector3(1.0, 0.0, 0.0);
  const Vector3 east = Vector3(0.0, 0.0, 1.0).cross(up_);
  // At a pole any direction is as good as another.
  east_ = east.norm() > 1e-9 ? Vector3(east / east.norm()) : Vector3(0.0, 1.0, 0.0);
  north_ = up_.cross(east_);
}

std::optional<MapPoint> MapPlane::At(const MapPlace& place) const {
  constexpr double kFarthest_rad = 2.8;
  const Vector3 there = Outwards(place);
  const double east = there.dot(east_), north = there.dot(north_);
  const double aside = std::hypot(east, north);
  const double away_rad = Atan2(aside, there.dot(up_));
  if (away_rad > kFarthest_rad) return std::nullopt;
  const double km = aside > 1e-12 ? kEarth_km * away_rad / aside : kEarth_km;
  return MapPoint{km * east, km * north};
}

bool MapPlane::MeetsParallel(double latitude_deg, double radius_km) const {
  const double middle_rad = Atan2(up_.z(), std::hypot(up_.x(), up_.y()));
  return std::fabs(latitude_deg / kDegPerRad - middle_rad) <= radius_km / kEarth_km;
}

bool MapPlane::MeetsMeridian(double longitude_deg, double radius_km) const {
  const double radius_rad = radius_km / kEarth_km;
  const SinCos longitude = SineCosine(longitude_deg / kDegPerRad);
  const double off_its_plane = std::fabs(up_.y() * longitude.cos - up_.x() * longitude.sin);
  return radius_rad > 0.5 * kPi || off_its_plane <= SineCosine(radius_rad).sin;
}

MapWindow::MapWindow(const std::vector<MapPoint>& points, double width_px, double most_px)
    : width_px_(width_px) {
  constexpr double kLeastSize_km = 60.0, kMargin = 1.16, kLeastHeight = 0.34;
  MapPoint low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
  for (const MapPoint& point : points)
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  MapPoint size_km;
  for (std::size_t i = 0; i < 2; ++i) {
    middle_[i] = 0.5 * (low[i] + high[i]);
    size_km[i] = std::max(kMargin * (high[i] - low[i]), kLeastSize_km);
  }
  height_px_ = std::clamp(width_px * size_km[1] / size_km[0], kLeastHeight * width_px, most_px);
  px_per_km_ = std::min(width_px / size_km[0], height_px_ / size_km[1]);
}

double MapWindow::farthest_km() const {
  return std::hypot(std::fabs(middle_[0]) + 0.5 * width_px_ / px_per_km_,
                    std::fabs(middle_[1]) + 0.5 * height_px_ / px_per_km_);
}

MapPoint MapWindow::Pixel(const MapPoint& point) const {
  return {0.5 * width_px_ + (point[0] - middle_[0]) * px_per_km_,
          0.5 * height_px_ - (point[1] - middle_[1]) * px_per_km_};
}

std::optional<std::array<MapPoint, 2>> MapWindow::Inside(const MapPoint& from, const MapPoint& to) const {
  const MapPoint a = Pixel(from), b = Pixel(to), size = {width_px_, height_px_};
  double first = 0.0, last = 1.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = b[i] - a[i];
    for (const auto& [towards, room] : {std::pair{-step, a[i]}, std::pair{step, size[i] - a[i]}}) {
      if (towards == 0.0 && room < 0.0) return std::nullopt;
      if (towards < 0.0) first = std::max(first, room / towards);
      if (towards > 0.0) last = std::min(last, room / towards);
    }
  }
  if (first > last) return std::nullopt;
  const auto at = [&](double part) {
    return MapPoint{a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
  };
  return std::array{at(first), at(last)};
}

std::string MapPath(const MapPlane& plane, const MapWindow& window, const std::vector<MapPlace>& line) {
  std::string path, at;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const auto from = plane.At(line[i - 1]), to = plane.At(line[i]);
    if (!from || !to) continue;
    const auto part = window.Inside(*from, *to);
    if (!part) continue;
    const auto text = [](const MapPoint& point) { return Number(point[0]) + " " + Number(point[1]); };
    const std::string begin = text((*part)[0]), end = text((*part)[1]);
    if (begin != at) path += "M" + begin;
    if (begin != end) path += "L" + end;
    at = end;
  }
  return path;
}

std::vector<MapPoint> ConvexHull(std::vector<MapPoint> points) {
  std::sort(points.begin(), points.end());
  std::vector<MapPoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const MapPoint& point : points) {
      while (hull.size() >= begin + 2) {
        const MapPoint &a = hull[hull.size() - 2], &b = hull.back();
        if ((b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // it begins the other side
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<std::vector<MapPlace>> CoastLines() {
  constexpr double kUnit_deg = 0.1;
  std::vector<std::vector<MapPlace>> lines;
  std::string_view text = CoastLineData();
  while (!text.empty()) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), row.size() + 1));
    if (row.empty() || row[0] == '#') continue;
    std::vector<MapPlace>& line = lines.emplace_back();
    const char* at = row.data();
    int x = 0, y = 0;
    while (at < row.data() + row.size()) {
      for (int* value : {&x, &y}) {
        int step = 0;
        at = std::from_chars(at, row.data() + row.size(), step).ptr + 1;
        *value += step;
      }
      line.push_back({y * kUnit_deg, x * kUnit_deg});
    }
  }
  return lines;
}

}  // namespace dispersa
