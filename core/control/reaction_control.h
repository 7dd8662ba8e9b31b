// Phase-plane logic of on-off thrusters, one axis.
#pragma once

#include "core/control/autopilot_config.h"

namespace dispersa {

/// Memory of one axis of the logic.
template <class T>
struct ThrusterStateOf {
  T direction = T(0.0);  ///< -1, 0, 1: the couple that fires
  T cycles_on = T(0.0);  ///< since it opened
};
using ThrusterState = ThrusterStateOf<double>;

/// Decides for one cycle. A couple opens when |e + k de/dt| leaves the deadband. It closes when the switching
/// value has come back across the hysteresis, but not before its minimum on-time. Returns the direction.
int StepThrusters(const ReactionControlLogic& logic, double error_rad, double rate_rad_s, int minimum_cycles,
                  ThrusterState& state);

}  // namespace dispersa
