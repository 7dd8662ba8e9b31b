#include "core/dynamics/air_data.h"

#include "core/environment/surroundings.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

AirState StateAt(const AirTable& table, double altitude_m) {
  const lanes::AirPressure<double> air = lanes::AirAt(table, altitude_m);
  return {air.energy_j_kg / kAirGasConstant_j_kg_k, air.pressure_pa, air.pressure_pa / air.energy_j_kg,
          Sqrt(1.4 * air.energy_j_kg)};
}

}  // namespace

AirData ComputeAirData(const Environment& environment, const Vector3& p, const Vector3& v) {
  AirData data;
  data.place = ToGeodetic(environment.earth, p);
  const double omega = environment.earth.rotation_rate_rad_s;
  data.v_AP_I = Vector3(v.x() + omega * p.y(), v.y() - omega * p.x(), v.z());
  const WindNorthEast wind = Evaluate(environment.wind, data.place.altitude_m);
  if (wind.north_m_s != 0.0 || wind.east_m_s != 0.0) {
    const Matrix3 R_IN = NedAxes(data.place.latitude_rad, data.place.longitude_rad);
    data.v_AP_I -= wind.north_m_s * R_IN.col(0) + wind.east_m_s * R_IN.col(1);
  }
  if (environment.turbulence) {
    const TurbulentWind gusts = Evaluate(*environment.turbulence, data.place.altitude_m);
    const Matrix3 R_IN = NedAxes(data.place.latitude_rad, data.place.longitude_rad);
    data.v_AP_I -= R_IN * Vector3(gusts.north_m_s, gusts.east_m_s, -gusts.up_m_s);
  }
  data.airspeed_m_s = data.v_AP_I.norm();
  const AirState still = environment.air ? StateAt(*environment.air, data.place.altitude_m)
                                         : StandardAtmosphere1976(data.place.altitude_m);
  const AirState air = Scaled(still, environment.density(data.place.altitude_m));
  data.density_kg_m3 = air.density_kg_m3;
  data.pressure_pa = air.pressure_pa;
  data.speed_of_sound_m_s = air.speed_of_sound_m_s;
  data.mach = air.speed_of_sound_m_s > 0.0 ? data.airspeed_m_s / air.speed_of_sound_m_s : 0.0;
  data.qbar_pa = 0.5 * air.density_kg_m3 * Square(data.airspeed_m_s);
  return data;
}

}  // namespace dispersa
