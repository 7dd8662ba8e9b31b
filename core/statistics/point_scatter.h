// Scatter in two or three dimensions: mean, covariance, and the regions of normal theory with what they
// really hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Of points with as many finite coordinates each; divisor n - 1. Sums run in the order given.
struct PointScatter {
  std::size_t n = 0;
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};
PointScatter PointScatterOf(const std::vector<std::vector<double>>& points);

/// A region (x - mean)' C^-1 (x - mean) <= c of the points themselves, c the quantile of chi squared: it
/// holds the stated share if they are normal, and what it holds of them says whether they are.
struct Containment {
  double stated = 0.0;
  std::int64_t inside = 0;
  double empirical = 0.0;
  Interval limits{0.0, 1.0};  ///< Clopper-Pearson, 95 %, of the region as if it had been given beforehand
  double scale = 0.0;         ///< c
};
/// None of a covariance that is singular: fewer points than coordinates and one, or no spread.
std::vector<Containment> ContainmentOf(const std::vector<std::vector<double>>& points,
                                       const PointScatter& scatter, const std::vector<double>& stated);

/// The ellipse of two coordinates at a scale.
struct ScatterEllipse {
  double semi_major = 0.0;
  double semi_minor = 0.0;
  double angle_rad = 0.0;  ///< of the major axis from the first coordinate to the second, in (-pi/2, pi/2]
};
ScatterEllipse EllipseOf(const std::vector<std::vector<double>>& covariance, double scale);
/// The ellipse as a closed polygon around a centre: the first point again at the end.
std::vector<std::array<double, 2>> OutlineOf(const ScatterEllipse& ellipse,
                                             const std::array<double, 2>& centre, int points);

}  // namespace dispersa
