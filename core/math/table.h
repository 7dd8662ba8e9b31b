// Interpolation tables of fixed layout: rows of doubles, arguments strictly increasing. Outside the arguments
// the end value holds. A caller for which that is wrong must check itself.
#pragma once

#include <cstddef>
#include <vector>

namespace dispersa {

/// Position of an argument in a grid: value = (1 - fraction) * y[index] + fraction * y[index + 1].
struct GridPosition {
  std::size_t index;
  double fraction;
};

/// Finds x in a strictly increasing grid of at least two points. Outside it the position is clamped.
GridPosition Locate(const std::vector<double>& grid, double x);

/// True when every value is finite and larger than the one before.
bool IsStrictlyIncreasing(const std::vector<double>& values);

/// y(x), linear between points, clamped outside.
struct Table1D {
  std::vector<double> x;  ///< strictly increasing, at least two points
  std::vector<double> y;  ///< as many as x

  double operator()(double at) const;
};

/// z(x, y), bilinear between points, clamped outside. z is stored row by row: z[ix * y.size() + iy].
struct Table2D {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;

  double operator()(const GridPosition& at_x, const GridPosition& at_y) const;
  double operator()(double at_x, double at_y) const { return (*this)(Locate(x, at_x), Locate(y, at_y)); }
};

}  // namespace dispersa
