#include "core/environment/wind_statistics.h"

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

std::vector<std::vector<double>> WindWeights(const WindStatistics& statistics) {
  const std::size_t levels = statistics.altitude_m.size();
  const double shared = statistics.correlation_ne;
  const double own = Sqrt(1.0 - Square(shared));
  std::vector<std::vector<double>> rows(2 * levels, std::vector<double>(2 * levels));
  for (std::size_t k = 0; k < levels; ++k) {
    std::vector<double>& north = rows[2 * k];
    std::vector<double>& east = rows[2 * k + 1];
    double renewal = 1.0;
    if (k > 0) {
      const double persistence =
          Exp((statistics.altitude_m[k - 1] - statistics.altitude_m[k]) / statistics.correlation_length_m);
      renewal = Sqrt(1.0 - Square(persistence));
      for (std::size_t i = 0; i < 2 * k; ++i) {
        north[i] = persistence * rows[2 * k - 2][i];
        east[i] = persistence * rows[2 * k - 1][i];
      }
    }
    north[2 * k] = renewal;
    east[2 * k] = renewal * shared;
    east[2 * k + 1] = renewal * own;
  }
  return rows;
}

}  // namespace dispersa
