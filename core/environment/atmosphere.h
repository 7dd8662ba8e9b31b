// US Standard Atmosphere, 1976 (NOAA-S/T 76-1562).
#pragma once

#include <vector>

namespace dispersa {

/// Air at one altitude. The perfect-gas law holds: density = pressure M / (8314.32 temperature), M the
/// mean molecular weight of that altitude.
struct AirState {
  double temperature_k;  ///< kinetic
  double pressure_pa;
  double density_kg_m3;
  double speed_of_sound_m_s;
};

/// Of dry air, J/(kg K), by the standard: 8314.32 J/(kmol K) over 28.9644 kg/kmol.
inline constexpr double kAirGasConstant_j_kg_k = 8314.32 / 28.9644;

/// Range of StandardAtmosphere1976.
inline constexpr double kAtmosphereBottom_m = -5000.0;
inline constexpr double kAtmosphereTop_m = 1.0e6;

/// The standard's air at a geometric altitude.
///
/// - Below 86 km: its defining equations. Seven layers of linear molecular-scale temperature in geopotential
///   altitude (r0 = 6356.766 km), and kinetic temperature by Table 8 (M/M0) from 80 km.
/// - From 86 km: its closed forms of temperature (equations 25 to 31). Pressure and molecular weight are
///   interpolated between 42 nodes of its tables: ln p by the cubic that has the hydrostatic slope -g M / (R
///   T) at each node, M by a monotone cubic. Density follows from the perfect-gas law. Pressure and density
///   stay within 0.1 % of an integration of the standard's own equations.
/// - All values are continuous. The speed of sound is sqrt(1.4 p / density). The standard prints none above
///   86 km, where it loses its meaning.
/// - Below -5 km the air of -5 km. Above 1000 km pressure and density are zero. Temperature (1000 K) and
/// speed of
///   sound are those of 1000 km, so that a Mach number stays finite.
AirState StandardAtmosphere1976(double geometric_altitude_m);
/// Geometric altitudes from above kAtmosphereBottom_m to kAtmosphereTop_m, rising, at which its functions are
/// not smooth: between two of them they are.
std::vector<double> AtmosphereKinks();

}  // namespace dispersa
