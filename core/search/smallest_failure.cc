#include "core/search/smallest_failure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/random/draws.h"

namespace dispersa {
namespace {

using Point = std::vector<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAlone = 3.0;        ///< of a coordinate by itself
constexpr double kDifference = 0.05;  ///< of a coordinate, for the slope of the margin
constexpr int kSections = 8;          ///< of a ray that are flown side by side: as many as lanes
constexpr double kWorthIt = 0.999;    ///< a nearer point is at least so much nearer

class Search {
 public:
  Search(const std::vector<Coordinate>& coordinates, const PointMargins& margins_at,
         const FailureSearchOptions& options)
      : coordinates_(coordinates), margins_at_(margins_at), options_(options) {
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (coordinates[i].kind == CoordinateKind::kNormal) counting_.push_back(i);
      if (coordinates[i].kind == CoordinateKind::kDirection) directions_.push_back(i);
    }
  }

  FailureSearchResult Run() {
    const Flown nominal = FlyOne(Point(coordinates_.size(), 0.0));
    if (Fails(nominal)) {
      Keep(nominal);
      return Result();
    }
    std::vector<Flown> starts = Starts();
    for (std::size_t i = 0; i < std::min(options_.starts, starts.size()); ++i) {
      // Each start may use its share of what is left.
      allowance_ =
          flights_ + (options_.max_flights - flights_) / (std::min(options_.starts, starts.size()) - i);
      Improve(starts[i]);
    }
    return Result();
  }

 private:
  struct Flown {
    Point point;
    double margin = kInfinity;
  };

  double Distance(const Point& point) const { return DistanceOf(coordinates_, point); }
  /// A lost flight fails; one that the budget did not allow has an infinite margin.
  static bool Fails(const Flown& flown) { return !(flown.margin > 0.0); }

  std::vector<Flown> Fly(std::vector<Point> points) {
    const std::size_t left = std::min(allowance_, options_.max_flights) - flights_;
    std::vector<Flown> flown;
    const std::vector<Point> allowed(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min(left, points.size())));
    const std::vector<double> margins = allowed.empty() ? std::vector<double>{} : margins_at_(allowed);
    flights_ += allowed.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double margin = i < margins.size() ? margins[i] : kInfinity;
      least_margin_ = std::min(least_margin_, std::isnan(margin) ? kInfinity : margin);
      flown.push_back({std::move(points[i]), margin});
    }
    return flown;
  }
  Flown FlyOne(const Point& point) { return Fly({point}).front(); }

  void Keep(const Flown& flown) {
    if (!Fails(flown) || (found_ && Distance(flown.point) >= Distance(best_.point))) return;
    found_ = true;
    best_ = flown;
  }

  /// The failing one that is nearest, if any.
  const Flown* Nearest(const std::vector<Flown>& flown) const {
    const Flown* nearest = nullptr;
    for (const Flown& each : flown) {
      if (!Fails(each) || Distance(each.point) > options_.reach) continue;
      if (nearest == nullptr || Distance(each.point) < Distance(nearest->point)) nearest = &each;
    }
    return nearest;
  }

  std::vector<Flown> Starts() {
    const std::size_t n = coordinates_.size();
    std::vector<Point> points;
    for (const std::size_t i : counting_) {
      for (const double z : {kAlone, -kAlone}) {
        points.emplace_back(n, 0.0);
        points.back()[i] = z;
      }
    }
    points.resize(std::min(points.size(), options_.max_flights / 4));
    for (std::uint64_t k = 0; k < options_.max_flights / 4; ++k) {
      Stream stream(options_.seed, k, "smallest_failure");
      Point& point = points.emplace_back(n, 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        const double z = stream.Normal();
        if (coordinates_[i].kind == CoordinateKind::kDirection) point[i] = z;
        if (coordinates_[i].kind == CoordinateKind::kNormal) point[i] = (k % 2 == 0 ? 1.0 : 2.0) * z;
      }
    }
    std::vector<Flown> flown = Fly(std::move(points));
    std::vector<Flown> starts = Failing(flown);
    if (starts.size() < options_.starts) {
      // Those that come nearest to failing by their distance, farther out.
      std::stable_sort(flown.begin(), flown.end(),
                       [](const Flown& a, const Flown& b) { return a.margin < b.margin; });
      std::vector<Point> stretched;
      for (const Flown& each : flown) {
        if (Fails(each) || stretched.size() >= options_.max_flights / 8) continue;
        for (const double factor : {1.5, 2.0, 3.0, 4.0}) {
          Point point = Scaled(each.point, factor);
          if (Distance(point) <= options_.reach) stretched.push_back(std::move(point));
        }
      }
      for (Flown& each : Failing(Fly(std::move(stretched)))) starts.push_back(std::move(each));
    }
    if (starts.empty() && !flown.empty()) starts = Approach(flown);
    return starts;
  }

  /// From each of the points that are nearest to failing, the nearest first, until something fails.
  std::vector<Flown> Approach(std::vector<Flown> flown) {
    std::stable_sort(flown.begin(), flown.end(),
                     [](const Flown& a, const Flown& b) { return a.margin < b.margin; });
    flown.resize(std::min(flown.size(), options_.starts));
    for (const Flown& start : flown) {
      std::vector<Flown> failing = ApproachFrom(start);
      if (!failing.empty()) return failing;
    }
    return {};
  }

  /// Along the slope of the margin.
  std::vector<Flown> ApproachFrom(Flown now) {
    for (int round = 0; round < 6; ++round) {
      std::vector<Point> points = TowardsLimit(now, {1.0, 0.5}, {1.0, 1.02, 1.1, 1.3});
      std::erase_if(points, [&](const Point& point) { return Distance(point) > options_.reach; });
      if (points.empty()) break;
      const std::vector<Flown> nearer = Fly(std::move(points));
      std::vector<Flown> failing = Failing(nearer);
      if (!failing.empty()) return failing;
      const auto least = std::min_element(nearer.begin(), nearer.end(),
                                          [](const Flown& a, const Flown& b) { return a.margin < b.margin; });
      if (!(least->margin < now.margin)) break;
      now = *least;
    }
    return {};
  }

  /// The nearest first. Those beyond the reach may come within it by shrinking.
  std::vector<Flown> Failing(const std::vector<Flown>& flown) const {
    std::vector<Flown> failing;
    for (const Flown& each : flown)
      if (Fails(each)) failing.push_back(each);
    std::stable_sort(failing.begin(), failing.end(),
                     [&](const Flown& a, const Flown& b) { return Distance(a.point) < Distance(b.point); });
    return failing;
  }

  /// What counts times a factor; directions stay.
  Point Scaled(Point point, double factor) const {
    for (const std::size_t i : counting_) point[i] *= factor;
    return point;
  }

  void Improve(Flown start) {
    Flown now = Prune(Shrink(std::move(start)));
    now = Shrink(now);
    Consider(now);
    while (flights_ < std::min(allowance_, options_.max_flights)) {
      Flown next = Shrink(Turn(Shrink(Slide(now))));
      if (!(Distance(next.point) < kWorthIt * Distance(now.point))) break;
      now = std::move(next);
      Consider(now);
    }
    Consider(Shrink(Prune(now)));
  }
  void Consider(const Flown& flown) {
    if (Distance(flown.point) <= options_.reach) Keep(flown);
  }

  /// The failing point nearest to zero on the ray through a failing one, as if all beyond it failed too.
  Flown Shrink(Flown failing) {
    double low = 0.0, high = 1.0;
    for (int round = 0; round < 3; ++round) {
      std::vector<Point> points;
      for (int i = 1; i < kSections; ++i)
        points.push_back(Scaled(failing.point, (low + (high - low) * i / kSections) / high));
      const std::vector<Flown> flown = Fly(std::move(points));
      const auto first =
          std::find_if(flown.begin(), flown.end(), [](const Flown& each) { return Fails(each); });
      const auto step = (high - low) / kSections;
      const auto at = static_cast<double>(first - flown.begin());
      low += step * at;
      if (first == flown.end()) continue;
      const double nearer = low + step;
      failing = *first;
      // Scales count from the point as it is now.
      low /= nearer;
      high = 1.0;
    }
    return failing;
  }

  /// Sets to zero what the failure does not need.
  Flown Prune(Flown failing) {
    for (int round = 0; round < 6; ++round) {
      std::vector<std::size_t> present;
      for (const std::size_t i : counting_)
        if (failing.point[i] != 0.0) present.push_back(i);
      if (present.size() < 2) return failing;
      std::vector<Point> without;
      for (const std::size_t i : present) {
        without.push_back(failing.point);
        without.back()[i] = 0.0;
      }
      const std::vector<Flown> flown = Fly(std::move(without));
      // Needless ones, the least needed (the least margin without it) first; as many of them as may go
      // together.
      std::vector<std::size_t> needless;
      for (std::size_t k = 0; k < present.size(); ++k)
        if (Fails(flown[k])) needless.push_back(k);
      if (needless.empty()) return failing;
      std::stable_sort(needless.begin(), needless.end(), [&](std::size_t a, std::size_t b) {
        return (std::isnan(flown[a].margin) ? -kInfinity : flown[a].margin) <
               (std::isnan(flown[b].margin) ? -kInfinity : flown[b].margin);
      });
      std::vector<Point> together;
      for (std::size_t count = needless.size(); count > 0; count /= 2) {
        together.push_back(failing.point);
        for (std::size_t k = 0; k < count; ++k) together.back()[present[needless[k]]] = 0.0;
      }
      const std::vector<Flown> fewer = Fly(std::move(together));
      const auto most =
          std::find_if(fewer.begin(), fewer.end(), [](const Flown& each) { return Fails(each); });
      if (most == fewer.end()) return failing;
      failing = *most;
    }
    return failing;
  }

  /// Slopes of the margin along the given coordinates; empty when a flight near is lost or not allowed.
  std::vector<double> Slopes(const Flown& at, const std::vector<std::size_t>& along) {
    if (!std::isfinite(at.margin)) return {};
    std::vector<Point> points;
    for (const std::size_t i : along) {
      points.push_back(at.point);
      points.back()[i] += kDifference;
    }
    std::vector<double> slopes;
    for (const Flown& each : Fly(std::move(points))) {
      if (!std::isfinite(each.margin)) return {};
      slopes.push_back((each.margin - at.margin) / kDifference);
    }
    return slopes;
  }

  /// Points on the way to the nearest point of the plane on which the margin would be 0 if it were as sloped
  /// everywhere, and a little farther out, because the limit bends. None without a slope.
  std::vector<Point> TowardsLimit(const Flown& now, const std::vector<double>& parts,
                                  const std::vector<double>& farther) {
    std::vector<Point> points;
    const std::vector<double> slopes = Slopes(now, counting_);
    const double squared = std::inner_product(slopes.begin(), slopes.end(), slopes.begin(), 0.0);
    if (!(squared > 0.0)) return points;
    double along = -now.margin;
    for (std::size_t k = 0; k < slopes.size(); ++k) along += slopes[k] * now.point[counting_[k]];
    for (const double part : parts) {
      for (const double factor : farther) {
        Point point = now.point;
        for (std::size_t k = 0; k < slopes.size(); ++k) {
          const std::size_t i = counting_[k];
          point[i] = factor * (point[i] + part * (along * slopes[k] / squared - point[i]));
        }
        points.push_back(std::move(point));
      }
    }
    return points;
  }

  /// Along the limit to where it is nearer.
  Flown Slide(const Flown& now) {
    std::vector<Point> points = TowardsLimit(now, {1.0, 0.6, 0.3, 0.1}, {1.0, 1.01, 1.04});
    if (points.empty()) return now;
    const std::vector<Flown> flown = Fly(std::move(points));
    const Flown* nearest = Nearest(flown);
    return nearest != nullptr && Distance(nearest->point) < Distance(now.point) ? *nearest : now;
  }

  /// Directions to where the margin is least: the same distance, and more room to come nearer.
  Flown Turn(const Flown& now) {
    if (directions_.empty() || !std::isfinite(now.margin)) return now;
    std::vector<Point> points;
    for (const std::size_t i : directions_) {
      for (const double by : {-0.4, -0.1, 0.1, 0.4}) {
        points.push_back(now.point);
        points.back()[i] += by;
      }
    }
    const std::vector<Flown> flown = Fly(std::move(points));
    const auto least = std::min_element(flown.begin(), flown.end(), [](const Flown& a, const Flown& b) {
      return (std::isnan(a.margin) ? -kInfinity : a.margin) < (std::isnan(b.margin) ? -kInfinity : b.margin);
    });
    return least != flown.end() && least->margin < now.margin ? *least : now;
  }

  FailureSearchResult Result() const {
    FailureSearchResult result;
    result.found = found_;
    result.flights = flights_;
    result.least_margin = least_margin_;
    if (!found_) return result;
    result.point = best_.point;
    result.distance = Distance(best_.point);
    result.margin = best_.margin;
    return result;
  }

  const std::vector<Coordinate>& coordinates_;
  const PointMargins& margins_at_;
  const FailureSearchOptions options_;
  std::vector<std::size_t> counting_, directions_;
  std::size_t flights_ = 0;
  std::size_t allowance_ = std::numeric_limits<std::size_t>::max();
  double least_margin_ = kInfinity;
  bool found_ = false;
  Flown best_;
};

}  // namespace

double DistanceOf(const std::vector<Coordinate>& coordinates, const Point& point) {
  double squares = 0.0;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (coordinates[i].kind == CoordinateKind::kNormal) squares += point[i] * point[i];
  return std::sqrt(squares);
}

FailureSearchResult FindSmallestFailure(const std::vector<Coordinate>& coordinates,
                                        const PointMargins& margins_at, const FailureSearchOptions& options) {
  return Search(coordinates, margins_at, options).Run();
}

}  // namespace dispersa
