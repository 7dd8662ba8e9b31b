// How a flight is guided, as its campaign says: plain data, SI and radians.
#pragma once

#include <optional>

#include "core/input/fields.h"
#include "core/math/constants.h"
#include "core/math/stages.h"

namespace dispersa {

struct GuidanceConfig {
  bool closed_loop = false;      ///< else the reference's attitude and ignition time are flown as they are
  bool steers_last_burn = true;  ///< else that burn is flown as it was planned at its ignition
  double period_s = 1.0;         ///< between two solutions while a motor burns
  int burns = 2;                 ///< that are guided, counted from the last one
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
                      "fly the reference's attitude and ignition time, or solve them anew in flight");
  fields.Choice<bool>("last_burn", {{"steered", true}, {"as_planned", false}}, guidance.steers_last_burn,
                      "solve anew while it burns, or fly as planned at its ignition",
                      guidance.steers_last_burn);
  fields.Quantity("period", kTime, Between(0.1, 10.0), guidance.period_s,
                  "between two solutions under thrust", guidance.period_s);
  fields.Integer("burns", 2, kMaxStages, guidance.burns, "guided ones, counted from the last", 2);
  // A launcher's attitude loops follow some degrees a second. A faster turn would be a loss of control.
  constexpr Range kRate = UpTo(20.0 * kRadPerDeg);
  fields.OptionalQuantity(
      "turn_rate", kAngularRate, kRate, guidance.turn_rate_rad_s,
      "largest commanded under thrust; default: 3 deg/s or 1.5 s x turn_acceleration, the smaller");
  fields.OptionalQuantity(
      "turn_acceleration", kAngularAcceleration, kRate, guidance.turn_acceleration_rad_s2,
      "largest commanded under thrust; default: 2 deg/s2 or 1/4 of the nozzles' most, the smaller");
  fields.OptionalQuantity(
      "coast_rate", kAngularRate, kRate, guidance.coast_rate_rad_s,
      "largest commanded in the coast; default: 0.5 deg/s or 10 s x coast_acceleration, the smaller");
  fields.OptionalQuantity(
      "coast_acceleration", kAngularAcceleration, kRate, guidance.coast_acceleration_rad_s2,
      "largest commanded in the coast; default: 0.05 deg/s2 or 1/3 of the thrusters' most, the smaller");
  fields.OptionalQuantity("settled", kAngle, kRate, guidance.settled_angle_rad,
                          "largest attitude error at which the last stage ignites; default: 0.25 deg or 1.5 "
                          "deadbands, the larger");
  fields.OptionalQuantity("settled_rate", kAngularRate, kRate, guidance.settled_rate_rad_s,
                          "largest rate error at which it ignites; default: 0.2 deg/s or 1.5 x the change by "
                          "one firing, the larger");
}

}  // namespace dispersa
