// Flow properties at a moving point, and its velocity relative to the air.
#pragma once

#include <memory>

#include "core/environment/air_table.h"
#include "core/environment/atmosphere.h"
#include "core/environment/density_factor.h"
#include "core/environment/earth.h"
#include "core/environment/turbulence.h"
#include "core/environment/wind.h"
#include "core/math/linear.h"

namespace dispersa {

/// Earth and weather of a flight. The air turns with the Earth, and the wind is added.
struct Environment {
  Earth earth = Wgs84();
  Wind wind;
  DensityFactor density;
  std::shared_ptr<const TurbulenceField> turbulence = {};  ///< added to the wind (null: none)
  std::shared_ptr<const AirTable> air = {};                ///< measured (null: the standard's)
};

struct AirData {
  Geodetic place;  ///< the longitude is measured from the x axis of the frame of p: right ascension
  Vector3 v_AP_I;  ///< velocity relative to the air, m/s
  double airspeed_m_s = 0.0;
  double density_kg_m3 = 0.0;
  double pressure_pa = 0.0;
  double speed_of_sound_m_s = 0.0;
  double mach = 0.0;
  double qbar_pa = 0.0;
};

/// At position p_EoP_I with inertial velocity v_IP_I. The Earth is symmetric about its axis, so time does
/// not enter.
AirData ComputeAirData(const Environment& environment, const Vector3& p_EoP_I, const Vector3& v_IP_I);

}  // namespace dispersa
