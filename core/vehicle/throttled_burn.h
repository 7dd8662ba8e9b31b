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
/// Burn of `propellant_kg`, of which the engine's residual never flows. While the throttle's level is linear,
/// the flow is linear too. The time of depletion then solves a quadratic equation.
ThrottledBurn Throttled(const Motor& engine, double propellant_kg, double full_flow_kg_s,
                        const CutOffCommand& command);

}  // namespace dispersa
