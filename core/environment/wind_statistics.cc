#include "core/environment/wind_statistics.h"

#include <cassert>
#include <cmath>

#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {

WindTable DrawWind(const WindStatistics& statistics, const std::vector<double>& standard_normals) {
  assert(standard_normals.size() == NormalsFor(statistics));
  const std::size_t levels = statistics.altitude_m.size();
  const double shared = statistics.correlation_ne;
  const double own = Sqrt(1.0 - Square(shared));
  WindTable table{statistics.altitude_m, std::vector<double>(levels), std::vector<double>(levels)};
  double north = 0.0;
  double east = 0.0;
  for (std::size_t k = 0; k < levels; ++k) {
    const double persistence = k == 0 ? 0.0
                                      : Exp((statistics.altitude_m[k - 1] - statistics.altitude_m[k]) /
                                            statistics.correlation_length_m);
    const double renewal = Sqrt(1.0 - Square(persistence));
    const double e_north = standard_normals[2 * k];
    const double e_east = shared * e_north + own * standard_normals[2 * k + 1];
    north = persistence * north + renewal * e_north;
    east = persistence * east + renewal * e_east;
    table.north_m_s[k] = statistics.mean_north_m_s[k] + statistics.sigma_north_m_s[k] * north;
    table.east_m_s[k] = statistics.mean_east_m_s[k] + statistics.sigma_east_m_s[k] * east;
  }
  return table;
}

}  // namespace dispersa
