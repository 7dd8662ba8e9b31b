// The burn of a liquid engine by command: its throttle up to cut-off or depletion, prepared like a thrust
// curve.
#pragma once

#include <cmath>

#include "core/vehicle/vehicle.h"

namespace dispersa {

struct ThrottledBurn {
  BurnCurve curve;       ///< levels are parts of full thrust and flow
  double left_kg = 0.0;  ///< of the propellant at the end: the residual, or more
};
/// A command to end a burn, since ignition. The thrust decays linearly from its level then to 0.
struct CutOffCommand {
  double at_s = HUGE_VAL;
  double tail_off_s = 0.0;
};
/// What an engine burns.
struct Supply {
  double propellant_kg;
  double residual_kg;  ///< the part of it that never flows
  double full_flow_kg_s;
};
/// While the throttle's level is linear, the flow is linear too. The time of depletion then solves a
/// quadratic equation.
ThrottledBurn Throttled(const Throttle& throttle, const Supply& supply, const CutOffCommand& command);

}  // namespace dispersa
