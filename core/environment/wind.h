// Wind over altitude: the sum of jet stream, table, gusts and a steady part.
//
// A direction is where the wind comes from, clockwise from north. Components are the velocity of the air.
// Altitudes are geodetic.
#pragma once

#include <string>
#include <vector>

namespace dispersa {

class Fields;

/// Velocity of the air over the ground, m/s.
struct WindNorthEast {
  double north_m_s = 0.0;
  double east_m_s = 0.0;
};

/// Components of a wind of a speed (m/s) that comes from an azimuth (rad, clockwise from north).
WindNorthEast FromAzimuth(double speed_m_s, double azimuth_from_rad);

/// Jet stream: speed max cos²(pi/2 (h - altitude) / width) within one width of its altitude, zero beyond. So
/// width is the full width at half maximum, and also the distance from the peak to calm. With width <=
/// altitude the ground is calm. Peak value and altitude are exact and the slope is continuous. The 95 % winds
/// of the worst month over Vandenberg and Cape Canaveral (Range Reference Atmosphere 2019) peak at 11 and 12
/// km and are 12 and 13 km wide at half maximum.
struct JetStream {
  double max_speed_m_s;
  double altitude_m;
  double width_m;
  double azimuth_from_rad;
};

/// Components over altitude, linear between points. Below, the first value holds. Above the last point the
/// wind fades linearly to zero over kWindFade_m, since measured profiles end where air still moves.
struct WindTable {
  std::vector<double> altitude_m = {};  ///< strictly increasing, at least two
  std::vector<double> north_m_s = {};
  std::vector<double> east_m_s = {};
};
/// The columns. `allowed` gives their allowed lengths.
void Describe(Fields& fields, WindTable& table, const char* allowed);
inline constexpr double kWindFade_m = 10000.0;

/// Discrete gust: speed/2 (1 - cos(2 pi x / length)) at x from 0 to length above its start. Half the length
/// is the build-up of MIL-F-8785C (3.7.3.2), the other half its mirror image.
struct Gust {
  double speed_m_s;
  double start_altitude_m;
  double length_m;
  double azimuth_from_rad;
};

using SteadyWind = WindNorthEast;

/// Sum of its parts. Without parts it is calm.
struct Wind {
  std::vector<JetStream> jets = {};
  std::vector<WindTable> tables = {};
  std::vector<Gust> gusts = {};
  SteadyWind steady = {};
};

WindNorthEast Evaluate(const Wind& wind, double altitude_m);

}  // namespace dispersa
