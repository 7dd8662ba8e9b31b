// Sensors of attitude and rates as the vehicle's file describes them.
#pragma once

#include <string>
#include <vector>

#include "core/input/fields.h"

namespace dispersa {

/// A rate gyro of three axes: second order over the true rate of its place, sampled and rounded.
struct RateGyro {
  std::string name;
  double station_m = 0.0;
  double bandwidth_rad_s = 0.0;  ///< 0: follows at once
  double damping_ratio = 0.7;
  double quantum_rad_s = 0.0;  ///< 0: none
  int sample_ticks = 1;
};
/// Rate gyros a vehicle has at most.
inline constexpr int kRateGyros = 3;

inline void Describe(Fields& fields, RateGyro& gyro) {
  fields.Text("name", gyro.name, "used by the autopilot");
  fields.Quantity("station", kLength, kNonNegative, gyro.station_m, "station of the gyro");
  fields.Quantity("bandwidth", kFrequency, kPositive, gyro.bandwidth_rad_s,
                  "natural frequency; default: no lag", 0.0);
  fields.Number("damping_ratio", kPositive, gyro.damping_ratio, "of a gyro with a bandwidth", 0.7);
  fields.Quantity("quantum", kAngularRate, kPositive, gyro.quantum_rad_s, "step of its output; default: none",
                  0.0);
  fields.Integer("sample_ticks", 1, 100, gyro.sample_ticks, "ticks of the autopilot between samples", 1);
}

/// Sensors of attitude and rates. Without rate gyros the inertial unit gives the rates.
struct Sensors {
  double inertial_unit_station_m = 0.0;
  std::vector<RateGyro> rate_gyros;
};

inline void Describe(Fields& fields, Sensors& sensors) {
  fields.Map("inertial_unit", "measures the attitude", [&](Fields& unit) {
    unit.Quantity("station", kLength, kNonNegative, sensors.inertial_unit_station_m,
                  "station of the inertial unit");
  });
  fields.List("rate_gyros", 0, kRateGyros, sensors.rate_gyros, "measure the rates, instead of the unit");
}

}  // namespace dispersa
