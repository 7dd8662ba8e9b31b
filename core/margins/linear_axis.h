// The flight's own equations of motion, linearised about one axis at one instant.
#pragma once

#include "core/control/autopilot.h"
#include "core/dynamics/launcher.h"
#include "core/flight/sensor_model.h"
#include "core/flight/tick_sample.h"
#include "core/margins/loop_margins.h"

namespace dispersa {

/// The vehicle's path while it turns.
enum class LateralPath {
  kHeld,    ///< stays: incidence changes with attitude alone, which the frequencies of most loops justify
  kDrifts,  ///< the lateral velocity is a state: it changes the incidence too
};

/// Central differences of LauncherModel::Derivative about a powered instant, so that the plant is written
/// only once. The vehicle turns about the axis through its centre of gravity while the wind stays. A path
/// that drifts adds a last state in pitch and yaw: the velocity, m/s, across the body's axis at the instant.
/// It is positive where it adds to the incidence as attitude does (along +z in pitch, -y in yaw).
AxisPlant LineariseAxis(const LauncherPlant& plant, const TickSample& sample, Axis axis,
                        const SensorModel& sensors, LateralPath path = LateralPath::kHeld);

/// The autopilot's law of an axis about zero error. `adapting` includes the adaptation, if the law has any.
/// Adaptive augmenting control is linearised at its total gain of 1.
LinearLaw LineariseLaw(const AutopilotModel& autopilot, int stage, double since_ignition_s, Axis axis,
                       bool adapting);

/// Sides of zero error and zero rate, -1 or 1: what the rules have learnt gives the rule surface an edge
/// there.
struct ErrorSide {
  int error = 1;
  int rate = 1;
};

/// The same law adapting, with the values learnt until the sample. It is linearised about zero error, to
/// which the adaptation steers, but on one side of it. The rules' slopes are those towards the neighbours of
/// the central rule. The augmentation's total gain is the sample's.
LinearLaw LineariseLearntLaw(const AutopilotModel& autopilot, const TickSample& sample, Axis axis,
                             ErrorSide side);

}  // namespace dispersa
