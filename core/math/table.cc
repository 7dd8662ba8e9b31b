#include "core/math/table.h"

#include <cmath>

namespace dispersa {

GridPosition Locate(const std::vector<double>& grid, double x) {
  const std::size_t last = grid.size() - 2;
  if (!(x > grid.front())) return {0, 0.0};
  if (x >= grid.back()) return {last, 1.0};
  std::size_t low = 0;
  std::size_t high = grid.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    if (x >= grid[middle])
      low = middle;
    else
      high = middle;
  }
  return {low, (x - grid[low]) / (grid[low + 1] - grid[low])};
}

bool IsStrictlyIncreasing(const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return false;
    if (i > 0 && !(values[i] > values[i - 1])) return false;
  }
  return true;
}

double Table1D::operator()(double at) const {
  const GridPosition p = Locate(x, at);
  return (1.0 - p.fraction) * y[p.index] + p.fraction * y[p.index + 1];
}

double Table2D::operator()(const GridPosition& at_x, const GridPosition& at_y) const {
  const std::size_t row = y.size();
  const double* z0 = &z[at_x.index * row + at_y.index];
  const double* z1 = z0 + row;
  const double low = (1.0 - at_y.fraction) * z0[0] + at_y.fraction * z0[1];
  const double high = (1.0 - at_y.fraction) * z1[0] + at_y.fraction * z1[1];
  return (1.0 - at_x.fraction) * low + at_x.fraction * high;
}

}  // namespace dispersa
