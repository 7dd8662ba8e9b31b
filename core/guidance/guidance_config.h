// How a flight is guided, as its campaign says: plain data, SI and radians.
#pragma once

#include <optional>

#include "core/input/fields.h"
#include "core/math/constants.h"

namespace dispersa {

struct GuidanceConfig {
  bool closed_loop = false;      ///< else the reference's attitude and ignition time are flown as they are
  bool steers_last_burn = true;  ///< else that burn is flown as it was planned at its ignition
  double period_s = 1.0;         ///< between two solutions while a motor burns
  // None: what the vehicle can do (guidance_limits.h).
  std::optional<double> turn_rate_rad_s = {};  ///< of the commanded attitude under thrust, by the nozzles
  std::optional<double> turn_acceleration_rad_s2 = {};
  std::optional<double> coast_rate_rad_s = {};  ///< and in the coast, by the reaction control
  std::optional<double> coast_acceleration_rad_s2 = {};
  /// The last stage ignites only if errors of attitude and rate are at most these.
  std::optional<double> settled_angle_rad = {};
  std::optional<double> settled_rate_rad_s = {};
};

inline void Describe(Fields& fields, GuidanceConfig& guidance) {
  fields.Choice<bool>("mode", {{"open_loop", false}, {"closed_loop", true}}, guidance.closed_loop,
                      "the reference's attitude and ignition time as they are, or solved anew in flight");
  fields.Choice<bool>("last_burn", {{"steered", true}, {"as_planned", false}}, guidance.steers_last_burn,
                      "solved anew while it burns, or flown as it was planned at its ignition",
                      guidance.steers_last_burn);
  fields.Quantity("period", kTime, Between(0.1, 10.0), guidance.period_s,
                  "between two solutions while a motor burns", guidance.period_s);
  // A launcher's attitude loops follow some degrees a second. A faster turn would be a loss of control.
  constexpr Range kRate = UpTo(20.0 * kRadPerDeg);
  fields.OptionalQuantity(
      "turn_rate", kAngularRate, kRate, guidance.turn_rate_rad_s,
      "of the commanded attitude under thrust; without, 3 deg/s or 1.5 s of turn_acceleration, the less");
  fields.OptionalQuantity(
      "turn_acceleration", kAngularAcceleration, kRate, guidance.turn_acceleration_rad_s2,
      "of that attitude; without, 2 deg/s2 or a quarter of what the nozzles can do, the less");
  fields.OptionalQuantity(
      "coast_rate", kAngularRate, kRate, guidance.coast_rate_rad_s,
      "of the commanded attitude in the coast; without, 0.5 deg/s or 10 s of coast_acceleration, the less");
  fields.OptionalQuantity(
      "coast_acceleration", kAngularAcceleration, kRate, guidance.coast_acceleration_rad_s2,
      "of that attitude; without, 0.05 deg/s2 or a third of what the thrusters can do, the less");
  fields.OptionalQuantity("settled", kAngle, kRate, guidance.settled_angle_rad,
                          "the last stage ignites only with its attitude this near to what is commanded; "
                          "without, 0.25 deg or 1.5 deadbands, the greater");
  fields.OptionalQuantity("settled_rate", kAngularRate, kRate, guidance.settled_rate_rad_s,
                          "and with its rate; without, 0.2 deg/s or 1.5 times what one firing changes, the "
                          "greater");
}

}  // namespace dispersa
