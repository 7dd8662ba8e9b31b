// How fast guidance may turn a vehicle, and how near to a command its reaction control settles.
#pragma once

#include <string>
#include <vector>

#include "core/guidance/guidance_config.h"

namespace dispersa {

struct AutopilotConfig;
struct Vehicle;

/// rad, s.
struct GuidanceLimits {
  double turn_rate_rad_s = 3.0 * kRadPerDeg;  ///< of the command under thrust, and its
  double turn_acceleration_rad_s2 = 2.0 * kRadPerDeg;
  double coast_rate_rad_s = 0.5 * kRadPerDeg;  ///< in the coast
  double coast_acceleration_rad_s2 = 0.05 * kRadPerDeg;
  double settled_angle_rad = 0.25 * kRadPerDeg;
  double settled_rate_rad_s = 0.2 * kRadPerDeg;
};

/// Angular accelerations that the guided part of a vehicle can reach, in pitch and yaw.
struct GuidedAuthority {
  /// By nozzles at their limit, at ignition: the less of the last two stacks.
  double nozzles_rad_s2 = 0.0;
  double thrusters_rad_s2 = 0.0;  ///< of the reaction control, with the last stack before its ignition
  double deadband_rad = 0.0;
  double least_change_rad_s = 0.0;  ///< of its rate: what one firing does
};

/// Precondition: two stages or more.
GuidedAuthority AuthorityOf(const Vehicle& vehicle, const AutopilotConfig& autopilot,
                            const GuidanceConfig& config = {});

/// The campaign's limits. Where it gives none: those of GuidanceLimits, or less, so that nozzles and
/// thrusters keep most of their authority for disturbances. A settled attitude is one that the deadband
/// allows.
GuidanceLimits LimitsOf(const GuidanceConfig& config, const GuidedAuthority& authority);

/// A setting that a campaign says and its vehicle cannot follow.
struct GuidanceExcess {
  std::string key;  ///< under `guidance`, in degrees
  std::string message, allowed;
};
std::vector<GuidanceExcess> ExcessesOf(const GuidanceConfig& config, const GuidedAuthority& authority);

}  // namespace dispersa
