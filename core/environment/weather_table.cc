#include "core/environment/weather_table.h"

#include <cmath>

#include "core/environment/atmosphere.h"
#include "core/input/fields.h"
#include "core/input/number_text.h"
#include "core/math/assertion.h"

namespace dispersa {
void Describe(Fields& fields, WeatherTable& table) {
  Describe(fields, static_cast<WindTable&>(table), "one value an altitude in each column");
  constexpr const char* kTwo = "two or three of temperature_k, pressure_* and density_kg_m3 are the air's";
  fields.OptionalQuantities("temperature", kTemperature, Between(100.0, 3000.0), 2, SIZE_MAX,
                            table.temperature_k, kTwo);
  fields.OptionalQuantities("pressure", kGasPressure, kPositive, 2, SIZE_MAX, table.pressure_pa,
                            "exponential between altitudes");
  fields.OptionalQuantities("density", kDensity, kPositive, 2, SIZE_MAX, table.density_kg_m3,
                            "exponential between altitudes; default: the standard's air");
  fields.Check([&fields, &table] {
    int given = 0;
    for (const auto* column : {&table.temperature_k, &table.pressure_pa, &table.density_kg_m3}) {
      if (column->empty()) continue;
      ++given;
      if (column->size() != table.altitude_m.size())
        return fields.Refuse("", "the columns have different lengths",
                             "one value an altitude in each column");
    }
    if (given == 0) return;
    if (given == 1)
      return fields.Refuse("", "one column alone does not give the air",
                           "two or three of temperature_k, pressure_* and density_kg_m3, or none");
    if (table.altitude_m.size() > kAirLevels)
      return fields.Refuse("altitude_m", "has " + std::to_string(table.altitude_m.size()) + " levels",
                           "up to 20,000 in a table with the air's state");
    for (std::size_t i = 0; i < table.altitude_m.size(); ++i) {
      const std::string at = "altitude_m[" + std::to_string(i) + "]";
      if (!(table.altitude_m[i] > kAtmosphereBottom_m &&
            table.altitude_m[i] + kWindFade_m < kAtmosphereTop_m))
        return fields.Refuse(
            at, "the air of " + FormatRounded(table.altitude_m[i]) + " m is not that of a flight",
            "altitudes above -5000 m and below 990,000 m");
      if (i > 0 && table.altitude_m[i] - table.altitude_m[i - 1] < kLeastLevel_m)
        return fields.Refuse(at, "is less than 10 m above the one before",
                             "altitudes 10 m apart or more, in a table with the air's state");
    }
  });
}

LevelAir AirOfLevel(const WeatherTable& table, std::size_t level) {
  DISPERSA_ASSERT(level < table.altitude_m.size(), level, table.altitude_m.size());
  DISPERSA_ASSERT(!table.pressure_pa.empty() || !table.density_kg_m3.empty());
  const auto energy = [&] { return kAirGasConstant_j_kg_k * table.temperature_k[level]; };
  if (table.pressure_pa.empty()) {
    const double density = table.density_kg_m3[level];
    return {density * energy(), density};
  }
  const double pressure = table.pressure_pa[level];
  return {pressure, table.density_kg_m3.empty() ? pressure / energy() : table.density_kg_m3[level]};
}

GasLawMiss MissOfGasLaw(const WeatherTable& table) {
  GasLawMiss miss;
  if (table.pressure_pa.empty() || table.density_kg_m3.empty() || table.temperature_k.empty()) return miss;
  for (std::size_t i = 0; i < table.altitude_m.size(); ++i) {
    const double law_pa = table.density_kg_m3[i] * kAirGasConstant_j_kg_k * table.temperature_k[i];
    const double part = table.pressure_pa[i] / law_pa - 1.0;
    if (std::fabs(part) > std::fabs(miss.part)) miss = {part, i};
  }
  return miss;
}

}  // namespace dispersa
