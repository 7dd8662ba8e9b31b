// Scatter in two or three dimensions: mean, covariance, the regions of normal theory, and the share of points
// that each region really contains.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Mean and covariance (divisor n - 1) of points. All points have the same number of finite coordinates. Sums
/// run in the given order.
struct PointScatter {
  std::size_t n = 0;
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};
PointScatter PointScatterOf(const std::vector<std::vector<double>>& points);

/// The region (x - mean)' C^-1 (x - mean) <= c, where c is the quantile of chi squared. It contains the
/// stated share if the points are normal. The share of points inside shows whether they are.
struct Containment {
  double stated = 0.0;
  std::int64_t inside = 0;
  double empirical = 0.0;
  Interval limits{0.0, 1.0};  ///< Clopper-Pearson, 95 %, as if the region had been fixed beforehand
  double scale = 0.0;         ///< c
};
/// Empty if the covariance is singular: no more points than coordinates, or no spread.
std::vector<Containment> ContainmentOf(const std::vector<std::vector<double>>& points,
                                       const PointScatter& scatter, const std::vector<double>& stated);

/// The ellipse of two coordinates at the scale c; semi-axes in the unit of the coordinates.
struct ScatterEllipse {
  double semi_major = 0.0;
  double semi_minor = 0.0;
  double angle_rad =
      0.0;  ///< from the first coordinate's axis to the major axis, towards the second, in (-pi/2, pi/2]
};
ScatterEllipse EllipseOf(const std::vector<std::vector<double>>& covariance, double scale);
/// The ellipse as a closed polygon around `centre`. The first point is repeated at the end.
std::vector<std::array<double, 2>> OutlineOf(const ScatterEllipse& ellipse,
                                             const std::array<double, 2>& centre, int points);

}  // namespace dispersa
