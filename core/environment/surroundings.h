// Gravitation, air and wind around W flights side by side (core/math/lanes.h), as functions of position
// alone.
#pragma once

#include "core/environment/air_table.h"
#include "core/environment/atmosphere.h"
#include "core/environment/earth.h"
#include "core/environment/weather_profile.h"
#include "core/math/constants.h"
#include "core/math/lane_vector.h"
#include "core/math/row_memory.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A place on the ellipsoid by sines and cosines: no arctangent is needed in flight.
template <class T>
struct Place {
  T altitude_m;
  T sin_latitude, cos_latitude;  ///< geodetic
  T axis_distance_m;
  T inverse_r, inverse_r2;  ///< of the distance from the centre
};

/// One step of Bowring's iteration (ToGeodetic takes two). It leaves 3e-13 rad of latitude near the Earth.
/// The altitude is stationary in latitude, so only its rounding is left.
template <class T>
DISPERSA_INLINE Place<T> PlaceAt(const Earth& earth, Vector<T> p) {
  const double a = earth.equatorial_radius_m, aspect = 1.0 - earth.flattening, b = a * aspect;
  const double e2 = earth.flattening * (2.0 - earth.flattening);
  const double axial = e2 * a / aspect, equatorial = e2 * a;
  Place<T> o;
  const T rho2 = Fma(p.x, p.x, p.y * p.y);
  const T rho = Sqrt(rho2);
  o.axis_distance_m = rho;
  o.inverse_r2 = T(1.0) / Fma(p.z, p.z, rho2);
  o.inverse_r = Sqrt(o.inverse_r2);
  const T c0 = rho * T(a), s0 = p.z * T(b) * Fma(T(axial), o.inverse_r, T(1.0));
  const T k0 = T(1.0) / Sqrt(Fma(c0, c0, s0 * s0));
  const T c = c0 * k0, s = s0 * k0;
  const T north = Fma(T(axial) * s, s * s, p.z);
  const T outward = Fma(T(-equatorial) * c, c * c, rho);
  const T k = T(1.0) / Sqrt(Fma(north, north, outward * outward));
  o.sin_latitude = north * k;
  o.cos_latitude = outward * k;
  o.altitude_m = Fma(rho, o.cos_latitude, p.z * o.sin_latitude) -
                 T(a) * Sqrt(Fma(T(-e2) * o.sin_latitude, o.sin_latitude, T(1.0)));
  return o;
}

/// Gravitation of earth.h at a place already located.
template <class T>
DISPERSA_INLINE Vector<T> GravitationAt(const Earth& earth, Vector<T> p, const Place<T>& at) {
  const T central = T(-earth.mu_m3_s2) * at.inverse_r2 * at.inverse_r;
  const T oblate = T(1.5 * earth.j2 * earth.equatorial_radius_m * earth.equatorial_radius_m) * at.inverse_r2;
  const T polar = T(5.0) * p.z * p.z * at.inverse_r2;
  const T equatorial = central * Fma(-oblate, polar - T(1.0), T(1.0));
  return {equatorial * p.x, equatorial * p.y, central * Fma(-oblate, polar - T(3.0), T(1.0)) * p.z};
}

template <class T>
struct AirPressure {
  T pressure_pa, energy_j_kg;  ///< energy: pressure / density
};
/// A row of an air table in each lane.
template <class T>
using AirRows = RowMemory<T, AirTable::kRowSize>;

/// A table for each lane; null: the standard's.
template <class T>
struct AirTables {
  const AirTable* of[kWidth<T>];
};

/// Finds the rows of the lanes at `z` that `found` does not name.
template <class T>
DISPERSA_OUT_OF_LINE void FindAir(const AirTables<T>& tables, T z, MaskOf<T> found, AirRows<T>& rows) {
  const unsigned known = Bits(found);
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    if (known >> lane & 1u) continue;
    const AirTable& table = tables.of[lane] == nullptr ? StandardAir() : *tables.of[lane];
    const double* edges = table.edges.data();
    const double bucket = (Lane(z, lane) - kAtmosphereBottom_m) * table.buckets_per_m;
    unsigned cell = table.bucket.data()[static_cast<int>(bucket)];
    while (Lane(z, lane) >= edges[cell + 1]) ++cell;
    while (cell > 0 && Lane(z, lane) < edges[cell]) --cell;  // rounding had put it into the next bucket
    rows.range.Set(lane, edges[cell], edges[cell + 1]);
    rows.SetRow(lane, table.rows.data() + AirTable::kRowSize * cell);
  }
}

/// The standard's air is within kAirTableTolerance of StandardAtmosphere1976. `rows` belong to these tables.
template <class T>
DISPERSA_INLINE AirPressure<T> AirAt(const AirTables<T>& tables, T altitude_m, AirRows<T>& rows) {
  const T z = Clamp(altitude_m, T(kAtmosphereBottom_m), T(kAtmosphereTop_m));
  const auto found = rows.range.Contains(z);
  if (!All(found)) FindAir(tables, z, found, rows);
  const T* c = rows.c;
  const T u = (z - c[0]) * c[1];
  AirPressure<T> air;
  air.pressure_pa = Fma(u, Fma(u, Fma(u, Fma(u, Fma(u, Fma(u, c[8], c[7]), c[6]), c[5]), c[4]), c[3]), c[2]);
  air.energy_j_kg = Fma(u, Fma(u, Fma(u, Fma(u, Fma(u, c[14], c[13]), c[12]), c[11]), c[10]), c[9]);
  air.pressure_pa = Select(altitude_m > T(kAtmosphereTop_m), T(0.0), air.pressure_pa);
  return air;
}
template <class T>
DISPERSA_INLINE AirPressure<T> AirAt(const AirTable& table, T altitude_m) {
  AirTables<T> tables;
  AirRows<T> rows;
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    tables.of[lane] = &table;
    rows.range.Forget(lane);
  }
  return AirAt(tables, altitude_m, rows);
}

/// Wind and air of one flight each.
template <class T>
struct FlownWeather : WeatherNumbers<T> {
  const WeatherProfile* profile[kWidth<T>];  ///< null: calm
  AirTables<T> air;
  bool has_profiles, has_updrafts;
  mutable AirRows<T> air_rows;  ///< of the flight's air, and
  mutable RowMemory<T, WeatherProfile::kRowSize> profile_rows;
};

/// `from` must outlive the flight.
template <class T>
DISPERSA_INLINE void SetWeather(FlownWeather<T>& w, int lane, const FlightWeather& from) {
  SetLane<WeatherNumbers>(w, lane, from);
  w.profile[lane] = from.profile.is_calm() ? nullptr : &from.profile;
  w.air.of[lane] = from.air.get();
  w.air_rows.range.Forget(lane);
  w.profile_rows.range.Forget(lane);
  w.has_profiles = w.has_updrafts = false;
  for (const WeatherProfile* const profile : w.profile) {
    w.has_profiles |= profile != nullptr;
    w.has_updrafts |= profile != nullptr && profile->has_updraft;
  }
}

/// Speed of a JetStream.
template <class T>
DISPERSA_INLINE T JetSpeed(T altitude_m, T max_speed_m_s, T jet_altitude_m, T inverse_width) {
  const T x = (altitude_m - jet_altitude_m) * inverse_width;
  const T cosine = Cos(T(0.5 * kPi) * Clamp(x, T(-1.0), T(1.0)));
  return Select(Abs(x) < T(1.0), max_speed_m_s * cosine * cosine, T(0.0));
}
/// Speed of a Gust.
template <class T>
DISPERSA_INLINE T GustSpeed(T altitude_m, T speed_m_s, T start_m, T inverse_length) {
  const T x = (altitude_m - start_m) * inverse_length;
  const T within = Clamp(x, T(0.0), T(1.0));
  return Select((x > T(0.0)) & (x < T(1.0)), T(0.5) * speed_m_s * (T(1.0) - Cos(T(kTwoPi) * within)), T(0.0));
}

/// Finds the rows of the lanes' profiles, of the lanes that `found` does not name.
template <class T>
DISPERSA_OUT_OF_LINE void FindProfiles(const FlownWeather<T>& weather, T altitude_m, MaskOf<T> found) {
  static constexpr double kCalm[WeatherProfile::kRowSize] = {0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  auto& rows = weather.profile_rows;
  const unsigned known = Bits(found);
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    if (known >> lane & 1u) continue;
    if (weather.profile[lane] == nullptr) {
      rows.range.Set(lane, -kNoEnd, kNoEnd);
      rows.SetRow(lane, kCalm);
      continue;
    }
    const WeatherProfile& profile = *weather.profile[lane];
    const double* edges = profile.edges.data();
    const unsigned count = static_cast<unsigned>(profile.edges.size());
    unsigned low = 0, high = count;
    while (low < high) {
      const unsigned middle = (low + high) / 2;
      if (Lane(altitude_m, lane) >= edges[middle])
        low = middle + 1;
      else
        high = middle;
    }
    rows.range.Set(lane, low > 0 ? edges[low - 1] : -kNoEnd, low < count ? edges[low] : kNoEnd);
    rows.SetRow(lane, profile.rows.data() + WeatherProfile::kRowSize * low);
  }
}

template <class T>
struct Surroundings {
  Vector<T> gravitation_m_s2;
  Vector<T> wind_m_s;  ///< over the ground, in the axes of the position
  T altitude_m;
  T pressure_pa, density_kg_m3;
  T inverse_sound_s_m;  ///< 1 / speed of sound
};

/// At p_EoP_I. ComputeAirData explains the frames.
template <class T>
DISPERSA_INLINE Surroundings<T> SurroundingsAt(const Earth& earth, const FlownWeather<T>& weather,
                                               Vector<T> p) {
  const Place<T> at = PlaceAt(earth, p);
  Surroundings<T> o;
  o.altitude_m = at.altitude_m;
  o.gravitation_m_s2 = GravitationAt(earth, p, at);
  const AirPressure<T> air = AirAt(weather.air, at.altitude_m, weather.air_rows);
  const T inverse_energy = T(1.0) / air.energy_j_kg;
  T factor = weather.density_factor;
  T north(0.0), east(0.0), up(0.0);
  if (weather.has_profiles) {
    const auto found = weather.profile_rows.range.Contains(at.altitude_m);
    if (!All(found)) FindProfiles(weather, at.altitude_m, found);
    const T* c = weather.profile_rows.c;
    north = Fma(at.altitude_m, c[1], c[0]);
    east = Fma(at.altitude_m, c[3], c[2]);
    factor = factor * Fma(at.altitude_m, c[5], c[4]);
    if (weather.has_updrafts) up = Fma(at.altitude_m, c[7], c[6]);
  }
  o.pressure_pa = air.pressure_pa * factor;
  o.density_kg_m3 = o.pressure_pa * inverse_energy;
  // The standard's ratio of specific heats is 1.4, that of a measured air too.
  o.inverse_sound_s_m = Sqrt(inverse_energy * T(1.0 / 1.4));

  const auto in_jet = (Abs((at.altitude_m - weather.jet_altitude_m) * weather.jet_inverse_width) < T(1.0)) &
                      (weather.jet_speed_m_s > T(0.0));
  if (Any(in_jet)) {
    const T speed =
        JetSpeed(at.altitude_m, weather.jet_speed_m_s, weather.jet_altitude_m, weather.jet_inverse_width);
    north = Select(in_jet, Fma(speed, weather.jet_north, north), north);
    east = Select(in_jet, Fma(speed, weather.jet_east, east), east);
  }
  const T into_gust = (at.altitude_m - weather.gust_start_m) * weather.gust_inverse_length;
  const auto in_gust = (into_gust > T(0.0)) & (into_gust < T(1.0)) & (weather.gust_speed_m_s > T(0.0));
  if (Any(in_gust)) {
    const T speed =
        GustSpeed(at.altitude_m, weather.gust_speed_m_s, weather.gust_start_m, weather.gust_inverse_length);
    north = Select(in_gust, Fma(speed, weather.gust_north, north), north);
    east = Select(in_gust, Fma(speed, weather.gust_east, east), east);
  }
  o.wind_m_s = Zero<T>();
  const auto windy = (Abs(north) > T(0.0)) | (Abs(east) > T(0.0));
  if (Any(windy)) {
    // Columns north and east of NedAxes. On the axis any direction will do.
    const T inverse_rho = T(1.0) / Select(at.axis_distance_m > T(0.0), at.axis_distance_m, T(1.0));
    const T cos_longitude = p.x * inverse_rho, sin_longitude = p.y * inverse_rho;
    const T outward = -(north * at.sin_latitude);
    const Vector<T> wind{Fma(outward, cos_longitude, -(east * sin_longitude)),
                         Fma(outward, sin_longitude, east * cos_longitude), north * at.cos_latitude};
    o.wind_m_s = Select(windy, wind, o.wind_m_s);
  }
  const auto lifts = Abs(up) > T(0.0);
  if (weather.has_updrafts && Any(lifts)) {
    // Column down of NedAxes, turned round.
    const T inverse_rho = T(1.0) / Select(at.axis_distance_m > T(0.0), at.axis_distance_m, T(1.0));
    const T outward = up * at.cos_latitude * inverse_rho;
    const Vector<T> lifted{Fma(outward, p.x, o.wind_m_s.x), Fma(outward, p.y, o.wind_m_s.y),
                           Fma(up, at.sin_latitude, o.wind_m_s.z)};
    o.wind_m_s = Select(lifts, lifted, o.wind_m_s);
  }
  return o;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
