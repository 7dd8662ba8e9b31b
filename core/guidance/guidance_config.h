// How a flight is guided, as its campaign says: plain data, SI and radians.
#pragma once

#include "core/input/fields.h"
#include "core/math/constants.h"

namespace dispersa {

struct GuidanceConfig {
  bool closed_loop = false;      ///< else the reference's attitude and ignition time are flown as they are
  bool steers_last_burn = true;  ///< else that burn is flown as it was planned at its ignition
  double period_s = 1.0;         ///< between two solutions while a motor burns
  /// Of the commanded attitude under thrust, which the gimbals follow.
  double turn_rate_rad_s = 3.0 * kRadPerDeg;
  double turn_acceleration_rad_s2 = 2.0 * kRadPerDeg;
  /// And in the coast, where reaction control follows.
  double coast_rate_rad_s = 0.5 * kRadPerDeg;
  double coast_acceleration_rad_s2 = 0.05 * kRadPerDeg;
  /// The last stage ignites only with attitude and rate this near to what is commanded.
  double settled_angle_rad = 0.25 * kRadPerDeg;
  double settled_rate_rad_s = 0.2 * kRadPerDeg;
};

inline void Describe(Fields& fields, GuidanceConfig& guidance) {
  fields.Choice<bool>("mode", {{"open_loop", false}, {"closed_loop", true}}, guidance.closed_loop,
                      "the reference's attitude and ignition time as they are, or solved anew in flight");
  fields.Choice<bool>("last_burn", {{"steered", true}, {"as_planned", false}}, guidance.steers_last_burn,
                      "solved anew while it burns, or flown as it was planned at its ignition",
                      guidance.steers_last_burn);
  fields.Quantity("period", kTime, Between(0.1, 10.0), guidance.period_s,
                  "between two solutions while a motor burns", guidance.period_s);
  // Attitude loops of a launcher follow some degrees a second; more would be a loss of control.
  constexpr Range kRate = UpTo(20.0 * kRadPerDeg);
  fields.Quantity("turn_rate", kAngularRate, kRate, guidance.turn_rate_rad_s,
                  "of the commanded attitude under thrust, which the gimbals follow",
                  guidance.turn_rate_rad_s);
  fields.Quantity("turn_acceleration", kAngularAcceleration, kRate, guidance.turn_acceleration_rad_s2,
                  "of that attitude", guidance.turn_acceleration_rad_s2);
  fields.Quantity("coast_rate", kAngularRate, kRate, guidance.coast_rate_rad_s,
                  "of the commanded attitude in the coast, which reaction control follows",
                  guidance.coast_rate_rad_s);
  fields.Quantity("coast_acceleration", kAngularAcceleration, kRate, guidance.coast_acceleration_rad_s2,
                  "of that attitude", guidance.coast_acceleration_rad_s2);
  fields.Quantity("settled", kAngle, kRate, guidance.settled_angle_rad,
                  "the last stage ignites only with its attitude this near to what is commanded",
                  guidance.settled_angle_rad);
  fields.Quantity("settled_rate", kAngularRate, kRate, guidance.settled_rate_rad_s, "and with its rates",
                  guidance.settled_rate_rad_s);
}

}  // namespace dispersa
