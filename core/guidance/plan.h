// What the guidance may still decide, as seven numbers.
#pragma once

#include <array>

#include "core/guidance/mission.h"

namespace dispersa {

enum PlanUnknown {
  kBelowPitch,  ///< offset to the reference's attitude while the stage before the last burns, rad
  kBelowYaw,
  kIgnition,     ///< of the last stage, s since lift-off
  kPitchMiddle,  ///< of the last burn: pitch in L at half its nominal duration, rad
  kPitchHalf,    ///< by how much pitch is greater at its nominal end, rad
  kYawMiddle,
  kWaste,  ///< part of the last burn's ideal velocity that turning in yaw takes away
  kPlanUnknowns
};
/// The last burn's thrust points to pitch and yaw linear in time. A turn in yaw from +a to -a leaves sin(a)/a
/// of the ideal velocity along its middle; 1 - sin(a)/a = a²/6 - ... is what kWaste stands for, with a = √(6
/// kWaste).
struct Plan {
  std::array<double, kPlanUnknowns> value{};

  double ignition_s() const { return value[kIgnition]; }
  /// a, rad.
  double TurnHalf() const;
  /// Of the last burn; before it as at its beginning. `yaw_half` is the reference's own turn.
  Direction LastBurnAt(double since_ignition_s, double nominal_duration_s, double yaw_half_rad) const;
  /// Its slope, rad/s.
  Direction LastBurnRate(double nominal_duration_s, double yaw_half_rad) const;
};

/// What the guidance would do if everything were nominal, and how far it may depart from it.
struct PlanPrior {
  Plan nominal;
  double yaw_half_rad = 0.0;                  ///< of the reference's last burn
  std::array<double, kPlanUnknowns> scale{};  ///< a departure that costs 1
  std::array<double, kPlanUnknowns> low{}, high{};
};
PlanPrior BuildPrior(const GuidanceMission& mission);

}  // namespace dispersa
