// A balloon's sounding: levels as they were measured, and the weather table that they make.
//
// Source of the heights: WMO-No. 8, Guide to Instruments and Methods of Observation, volume I, upper-air
// pressure, temperature and humidity: geopotential by the hypsometric equation, and its conversion with
// normal gravity at the latitude (WGS-84). Source of the vapour: Bolton (1980), equation 10.
//
// Heights count from mean sea level, and altitudes from the ellipsoid. Both are taken as equal: the geoid is
// within 110 m of the ellipsoid.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "core/environment/weather_table.h"

namespace dispersa {

/// NaN: not measured there. Either height may be given. `source`: of the caller, such as its line.
struct SoundingLevel {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double height_m = kNone;        ///< geometric
  double geopotential_m = kNone;  ///< standard geopotential metres
  double pressure_pa = kNone;
  double temperature_k = kNone;
  double vapour_pa = kNone;  ///< partial pressure; none: dry air
  double density_kg_m3 = kNone;
  double north_m_s = kNone, east_m_s = kNone;
  int source = 0;

  bool has_height() const { return height_m == height_m; }
  bool has_wind() const { return north_m_s == north_m_s && east_m_s == east_m_s; }
};

/// Of a geopotential height (standard metres, 9.80665 m²/s² each) at a geodetic latitude, and back. Within 1
/// m of the Earth's own potential up to 60 km.
double GeometricHeight(double geopotential_m, double latitude_rad);
double GeopotentialHeight(double height_m, double latitude_rad);
/// Saturation over water at a temperature (Bolton, equation 10), Pa. Within 0.3 % from -35 to 35 °C.
double SaturationPressure(double temperature_k);

struct SoundingProfile {
  WeatherTable table;
  std::vector<int> sources;  ///< of each altitude of the table
  std::size_t levels = 0;    ///< as measured
  std::size_t without_wind = 0, without_air = 0, with_heights_by_pressure = 0, dropped = 0;
  double wind_top_m = 0.0;  ///< the last level with a wind
};

/// The table of a sounding, in order of altitude.
///
/// - A level without height, but with pressure, gets one by the hypsometric equation: between two levels with
///   heights so that their thickness holds, above the last one from there. Elsewhere it is dropped.
/// - Levels less than kLeastLevel_m apart are one: the lower one, with what it lacks from the upper one.
/// - The wind between levels with wind is linear in both components. Below them the lowest one holds. Above
///   them it fades to zero over kWindFade_m.
/// - The air between levels with air is as MeasuredAir has it, below and above them too. With fewer than two
///   such levels the table has no air.
///
/// `latitude_rad`: none is 45°. A table with fewer than two altitudes has no winds either.
SoundingProfile ProfileOf(std::vector<SoundingLevel> levels, std::optional<double> latitude_rad);

}  // namespace dispersa
