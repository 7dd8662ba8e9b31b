// A measured or forecast profile of the weather over altitude: wind, and the air's state if it is given.
#pragma once

#include <cstddef>
#include <vector>

#include "core/environment/wind.h"

namespace dispersa {

/// Least difference of two altitudes of a table with air.
inline constexpr double kLeastLevel_m = 10.0;
/// Altitudes of such a table at most.
inline constexpr std::size_t kAirLevels = 20000;

/// Columns of the air are empty or as long as the altitudes: none, or two or three of them. Two give the
/// third by the gas law of dry air, p = density R T. With three, pressure and density fly, and the
/// temperature is only checked.
struct WeatherTable : WindTable {
  std::vector<double> temperature_k = {};
  std::vector<double> pressure_pa = {};
  std::vector<double> density_kg_m3 = {};

  bool has_air() const { return !pressure_pa.empty() || !density_kg_m3.empty(); }
};
void Describe(Fields& fields, WeatherTable& table);

struct LevelAir {
  double pressure_pa, density_kg_m3;
};
/// Precondition: the table has air.
LevelAir AirOfLevel(const WeatherTable& table, std::size_t level);

/// Greatest relative difference of p and density R T, where all three are given, and its level.
struct GasLawMiss {
  double part = 0.0;
  std::size_t level = 0;
};
GasLawMiss MissOfGasLaw(const WeatherTable& table);

}  // namespace dispersa
