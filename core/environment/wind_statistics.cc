#include "core/environment/wind_statistics.h"

#include <algorithm>
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

std::vector<std::string> Problems(const WindStatistics& statistics) {
  const auto finite = [](double value) { return std::isfinite(value); };
  const auto deviation = [](double value) { return std::isfinite(value) && value >= 0.0; };
  const auto all = [](const std::vector<double>& values, auto condition) {
    return std::all_of(values.begin(), values.end(), condition);
  };
  const std::size_t levels = statistics.altitude_m.size();

  std::vector<std::string> problems;
  if (levels < 2) problems.emplace_back("wind statistics need at least two altitudes");
  if (!IsStrictlyIncreasing(statistics.altitude_m))
    problems.emplace_back("the altitudes of wind statistics must be finite and strictly increasing");
  if (statistics.mean_north_m_s.size() != levels || statistics.mean_east_m_s.size() != levels ||
      statistics.sigma_north_m_s.size() != levels || statistics.sigma_east_m_s.size() != levels)
    problems.emplace_back("wind statistics need a mean and a deviation north and east for each altitude");
  if (!all(statistics.mean_north_m_s, finite) || !all(statistics.mean_east_m_s, finite))
    problems.emplace_back("the means of wind statistics must be finite");
  if (!all(statistics.sigma_north_m_s, deviation) || !all(statistics.sigma_east_m_s, deviation))
    problems.emplace_back("the deviations of wind statistics must be finite and not negative");
  if (!(statistics.correlation_ne >= -1.0 && statistics.correlation_ne <= 1.0))
    problems.emplace_back("the correlation of north and east must be from -1 to 1");
  if (!(std::isfinite(statistics.correlation_length_m) && statistics.correlation_length_m > 0.0))
    problems.emplace_back("the correlation length of wind statistics must be finite and positive");
  return problems;
}

}  // namespace dispersa
