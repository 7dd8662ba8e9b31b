#include "core/environment/density_factor.h"

#include <algorithm>
#include <cmath>

namespace dispersa {

AirState Scaled(const AirState& air, double density_factor) {
  return {air.temperature_k, density_factor * air.pressure_pa, density_factor * air.density_kg_m3,
          air.speed_of_sound_m_s};
}

std::vector<std::string> Problems(const DensityFactor& factor) {
  const auto usable = [](double value) { return std::isfinite(value) && value >= 0.0; };
  std::vector<std::string> problems;
  if (!usable(factor.scale)) problems.emplace_back("the density factor must be finite and not negative");
  const Table1D& table = factor.by_altitude;
  if (table.x.empty() && table.y.empty()) return problems;
  if (table.x.size() < 2) problems.emplace_back("a density profile needs at least two altitudes");
  if (table.x.size() != table.y.size())
    problems.emplace_back("a density profile needs one factor for each altitude");
  if (!IsStrictlyIncreasing(table.x))
    problems.emplace_back("the altitudes of a density profile must be finite and strictly increasing");
  if (!std::all_of(table.y.begin(), table.y.end(), usable))
    problems.emplace_back("the factors of a density profile must be finite and not negative");
  return problems;
}

}  // namespace dispersa
