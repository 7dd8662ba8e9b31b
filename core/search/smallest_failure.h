// The smallest dispersion that fails, by a bounded local search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/search/dispersion_space.h"

namespace dispersa {

/// The distance of the metric to its limit at each point; all points are flown side by side. Positive inside,
/// 0 or less outside, NaN for a lost flight.
using PointMargins = std::function<std::vector<double>(const std::vector<std::vector<double>>& points)>;

struct FailureSearchOptions {
  std::size_t max_flights = 1000;
  std::size_t starts = 4;  ///< number of starting points
  double reach = 6.0;      ///< largest distance from zero, in standard deviations
  std::uint64_t seed = 1;
};

struct FailureSearchResult {
  bool found = false;
  std::vector<double> point;
  double distance = 0.0;
  double margin = 0.0;  ///< NaN: lost
  std::size_t flights = 0;
  double least_margin = 0.0;  ///< of all flights that were not lost
};

/// Euclidean distance from zero, over the coordinates that count.
double DistanceOf(const std::vector<Coordinate>& coordinates, const std::vector<double>& point);

/// Searches the failing point nearest to zero (no dispersion). The search is local, so a nearer one may
/// exist. Deterministic, at most max_flights flights:
///
/// 1. Fly every coordinate alone at ±3, and points drawn at one and two standard deviations. The failing ones
///    nearest to zero are the starts. If none fails, stretch the points nearest to failing up to `reach`; if
///    none fails then, follow the margin's slope from each of them.
/// 2. From each start: shrink along the ray to zero. Set to zero what the failure does not need (in the
/// manner
///    of A. Zeller and R. Hildebrandt, IEEE Trans. Softw. Eng. 28 (2002) 183-200). Go to the nearest point of
///    the plane that differences of the margin span (R. Rackwitz and B. Fiessler, Comput. Struct. 9 (1978)
///    489-494) while that comes nearer. Turn directions to where the margin is least.
///
/// A step is accepted only if its point fails and is nearer. So the returned point has been flown and fails.
FailureSearchResult FindSmallestFailure(const std::vector<Coordinate>& coordinates,
                                        const PointMargins& margins_at, const FailureSearchOptions& options);

}  // namespace dispersa
