// A flight's tables of wind and density over altitude, as one table of straight pieces.
#pragma once

#include <memory>
#include <vector>

#include "core/environment/air_table.h"
#include "core/environment/density_factor.h"
#include "core/environment/turbulence.h"
#include "core/environment/wind.h"
#include "core/math/aligned_rows.h"

namespace dispersa {

/// The steady wind plus all wind tables with their fading tops (Evaluate of the same parts, to rounding) plus
/// a turbulent field, and the density factor. A row has 8 doubles: north (m/s), east (m/s), factor and up
/// (m/s), each as constant and slope over altitude (m). Row k holds between edges k - 1 and k. The first and
/// the last row are open.
struct WeatherProfile {
  static constexpr int kRowSize = 8;

  std::vector<double> edges;  ///< strictly increasing
  AlignedRows rows;           ///< one more than there are edges

  bool has_updraft = false;  ///< up is not 0 everywhere

  bool is_calm() const { return rows.empty(); }  ///< no wind, factor 1
};

/// `turbulence`: null is none.
WeatherProfile BuildWeatherProfile(const Wind& wind, const DensityFactor& density,
                                   const TurbulenceField* turbulence = nullptr);

/// One flight's wind and air in the form of its equations: plain numbers and the profile. Directions are
/// unit components of the direction in which the air moves. A speed of 0 means none.
template <class T>
struct WeatherNumbers {
  T density_factor = T(1.0);
  /// JetStream, with the unit vector of where it blows to.
  T jet_speed_m_s = T(0.0), jet_altitude_m = T(0.0), jet_inverse_width = T(1.0);
  T jet_north = T(0.0), jet_east = T(0.0);
  /// Gust, likewise.
  T gust_speed_m_s = T(0.0), gust_start_m = T(0.0), gust_inverse_length = T(1.0);
  T gust_north = T(0.0), gust_east = T(0.0);
};
struct FlightWeather : WeatherNumbers<double> {
  WeatherProfile profile;                    ///< of everything else
  std::shared_ptr<const AirTable> air = {};  ///< measured (null: the standard's)
};
/// Prepares a wind with at most one jet stream and one gust, as a flight draws it.
FlightWeather PrepareWeather(const Wind& wind, const DensityFactor& density,
                             std::shared_ptr<const AirTable> air = {},
                             const TurbulenceField* turbulence = nullptr);

}  // namespace dispersa
