// The smallest dispersion that fails, by a bounded local search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/search/dispersion_space.h"

namespace dispersa {

/// How far inside its limit the metric is at each point, all flown side by side: positive inside, 0 or less
/// outside, NaN of a flight that was lost.
using PointMargins = std::function<std::vector<double>(const std::vector<std::vector<double>>& points)>;

struct FailureSearchOptions {
  std::size_t max_flights = 1000;
  std::size_t starts = 4;  ///< points from which is searched
  double reach = 6.0;      ///< no farther than so from nothing dispersed
  std::uint64_t seed = 1;
};

struct FailureSearchResult {
  bool found = false;
  std::vector<double> point;
  double distance = 0.0;
  double margin = 0.0;  ///< NaN: lost
  std::size_t flights = 0;
  double least_margin = 0.0;  ///< of all flights, the lost ones aside
};

/// Euclidean over the coordinates that count.
double DistanceOf(const std::vector<Coordinate>& coordinates, const std::vector<double>& point);

/// The failing point nearest to nothing dispersed that a local search finds, and a smaller one that it did
/// not find may exist. Deterministic, at most max_flights flights:
///
/// 1. Every coordinate alone at ±3, and points drawn at one and two standard deviations; the failing ones
/// nearest to
///    zero are the starts. Without any, the points nearest to failing are stretched up to `reach`, and the
///    last resort is to follow the margin's slope from each of them.
/// 2. From each start: shrink along the ray to zero; set to zero what the failure does not need (in the
/// manner of A.
///    Zeller and R. Hildebrandt, IEEE Trans. Softw. Eng. 28 (2002) 183-200); go to the nearest point of the
///    plane that differences of the margin span (R. Rackwitz and B. Fiessler, Comput. Struct. 9 (1978)
///    489-494) while that comes nearer; turn directions to where the margin is least.
///
/// Steps are accepted only if they fail and are nearer, so that what is returned has been flown and fails.
FailureSearchResult FindSmallestFailure(const std::vector<Coordinate>& coordinates,
                                        const PointMargins& margins_at, const FailureSearchOptions& options);

}  // namespace dispersa
