#include "core/vehicle/thin_table.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace dispersa {
namespace {

struct Chord {
  double need = 0.0;  // integral of the squares of its misses, 0 if all are tolerated
  std::size_t from = 0, to = 0, worst = 0;

  // The neediest piece comes first. The order of equal ones is fixed.
  bool operator<(const Chord& other) const {
    return need != other.need ? need < other.need : from > other.from;
  }
};

double GreatestValue(const std::vector<double>& values) {
  double greatest = 0.0;
  for (double value : values) greatest = std::max(greatest, std::fabs(value));
  return greatest;
}

double AreaOf(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += 0.5 * (y[i - 1] + y[i]) * (x[i] - x[i - 1]);
  return sum;
}

}  // namespace

std::vector<std::size_t> ChooseCorners(const std::vector<double>& x,
                                       const std::vector<const std::vector<double>*>& columns,
                                       std::size_t most, double tolerance) {
  std::vector<double> scales;
  for (const auto* column : columns) {
    const double greatest = GreatestValue(*column);
    scales.push_back(greatest > 0.0 ? 1.0 / greatest : 0.0);
  }
  const auto measure = [&](std::size_t from, std::size_t to) {
    Chord chord{0.0, from, to, from};
    double greatest = 0.0, sum = 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::vector<double>& y = *columns[c];
      const double slope = (y[to] - y[from]) / (x[to] - x[from]);
      for (std::size_t i = from + 1; i < to; ++i) {
        const double miss = std::fabs(y[i] - y[from] - slope * (x[i] - x[from])) * scales[c];
        sum += miss * miss * 0.5 * (x[i + 1] - x[i - 1]);
        if (miss > greatest) greatest = miss, chord.worst = i;
      }
    }
    if (greatest > tolerance) chord.need = sum;
    return chord;
  };
  std::vector<std::size_t> corners = {0, x.size() - 1};
  std::priority_queue<Chord> pieces;
  pieces.push(measure(0, x.size() - 1));
  while (corners.size() < most && pieces.top().need > 0.0) {
    const Chord piece = pieces.top();
    pieces.pop();
    corners.push_back(piece.worst);
    pieces.push(measure(piece.from, piece.worst));
    pieces.push(measure(piece.worst, piece.to));
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<double> FitCorners(const std::vector<double>& x, const std::vector<double>& values,
                               const std::vector<std::size_t>& corners) {
  const std::size_t count = corners.size();
  // Normal equations: the integrals of two hats, and of a hat and the table.
  std::vector<double> diagonal(count), above(count), right(count), at(count);
  for (std::size_t k = 0; k < count; ++k) at[k] = x[corners[k]];
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double width = at[k + 1] - at[k];
    diagonal[k] += width / 3.0;
    diagonal[k + 1] += width / 3.0;
    above[k] = width / 6.0;
    for (std::size_t i = corners[k]; i < corners[k + 1]; ++i) {
      // Simpson's rule is exact for a product of two straight lines.
      const double step = x[i + 1] - x[i];
      const double low = (x[i] - at[k]) / width, high = (x[i + 1] - at[k]) / width;
      const double middle = 0.5 * (values[i] + values[i + 1]) * 4.0;
      const double rising =
          step / 6.0 * (values[i] * low + middle * 0.5 * (low + high) + values[i + 1] * high);
      right[k + 1] += rising;
      right[k] += step / 6.0 * (values[i] + middle + values[i + 1]) - rising;
    }
  }
  // Where the table is 0 the fit is 0.
  for (std::size_t k = 0; k < count; ++k) {
    if (values[corners[k]] != 0.0) continue;
    diagonal[k] = 1.0;
    right[k] = 0.0;
    above[k] = 0.0;
    if (k > 0) above[k - 1] = 0.0;
  }
  // Gaussian elimination of the symmetric tridiagonal matrix.
  for (std::size_t k = 1; k < count; ++k) {
    const double factor = above[k - 1] / diagonal[k - 1];
    diagonal[k] -= factor * above[k - 1];
    right[k] -= factor * right[k - 1];
  }
  std::vector<double> fitted(count);
  for (std::size_t k = count; k-- > 0;)
    fitted[k] = (right[k] - (k + 1 < count ? above[k] * fitted[k + 1] : 0.0)) / diagonal[k];
  for (double& value : fitted) value = std::max(value, 0.0);
  const double area = AreaOf(at, fitted);
  if (area > 0.0)
    for (double& value : fitted) value *= AreaOf(x, values) / area;
  return fitted;
}

double GreatestMiss(const std::vector<double>& x, const std::vector<double>& values,
                    const std::vector<std::size_t>& corners, const std::vector<double>& fitted) {
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const std::size_t from = corners[k], to = corners[k + 1];
    const double slope = (fitted[k + 1] - fitted[k]) / (x[to] - x[from]);
    for (std::size_t i = from; i <= to; ++i)
      worst = std::max(worst, std::fabs(values[i] - fitted[k] - slope * (x[i] - x[from])));
  }
  const double greatest = GreatestValue(values);
  return greatest > 0.0 ? worst / greatest : 0.0;
}

}  // namespace dispersa
