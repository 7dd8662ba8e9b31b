// Random wind profiles from the statistics of a site.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/environment/wind.h"

namespace dispersa {

/// Normal winds by altitude: mean and standard deviation of each component, their correlation at one
/// altitude, and the distance over which a component's correlation with itself falls to 1/e.
struct WindStatistics {
  std::vector<double> altitude_m = {};  ///< strictly increasing, at least two
  std::vector<double> mean_north_m_s = {};
  std::vector<double> mean_east_m_s = {};
  std::vector<double> sigma_north_m_s = {};
  std::vector<double> sigma_east_m_s = {};
  double correlation_ne = 0.0;
  double correlation_length_m = 0.0;
};

/// What stands beside the columns, and the columns: at most so many levels.
void Describe(Fields& fields, WindStatistics& statistics);
void DescribeLevels(Fields& fields, WindStatistics& statistics, std::size_t most);

/// How many standard normals DrawWind takes: two a level.
inline std::size_t NormalsFor(const WindStatistics& statistics) { return 2 * statistics.altitude_m.size(); }

/// One profile: a first-order autoregression in altitude. With rho = exp(-dh / correlation length) the
/// standardised components z of a level are rho z' + sqrt(1 - rho²) e of the level below, z = e at the
/// lowest, where e_north = normals[2k] and e_east = r normals[2k] + sqrt(1 - r²) normals[2k+1], r the
/// correlation of the components. So every level has exactly the given means, deviations and correlation,
/// and two levels dh apart the correlation exp(-dh / length).
/// standard_normals has NormalsFor(statistics) values.
WindTable DrawWind(const WindStatistics& statistics, const std::vector<double>& standard_normals);

}  // namespace dispersa
