// Random wind profiles from the statistics of a site.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/environment/wind.h"

namespace dispersa {

/// Normal winds by altitude: mean and standard deviation of each component, correlation of the two at one
/// altitude, and correlation length: the distance over which a component's correlation with itself falls to
/// 1/e.
struct WindStatistics {
  std::vector<double> altitude_m = {};  ///< strictly increasing, at least two
  std::vector<double> mean_north_m_s = {};
  std::vector<double> mean_east_m_s = {};
  std::vector<double> sigma_north_m_s = {};
  std::vector<double> sigma_east_m_s = {};
  double correlation_ne = 0.0;
  double correlation_length_m = 0.0;
};

/// The columns and the keys beside them. `most_levels`, where given, is the largest number of levels.
void Describe(Fields& fields, WindStatistics& statistics);
void DescribeLevels(Fields& fields, WindStatistics& statistics, std::size_t most);

/// The standardised components of every level (north, east, level by level) as weighted sums of independent
/// standard normals: one row a component, as many weights. A first-order autoregression in altitude, with
/// rho = exp(-dh / correlation length): z = rho z' + sqrt(1 - rho²) e, where z' are those of the level below.
/// At the lowest level z = e. With the normals n, e_north = n[2k] and e_east = r n[2k] + sqrt(1 - r²)
/// n[2k+1], where r is the correlation of the components. Every level then has exactly the given correlation.
/// Two levels dh apart have the correlation exp(-dh / length).
std::vector<std::vector<double>> WindWeights(const WindStatistics& statistics);

}  // namespace dispersa
