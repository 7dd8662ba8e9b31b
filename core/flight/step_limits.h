// What the engine's step resolves, and what of a dispersed vehicle cannot be flown at all.
//
// A step is a tick of the autopilot. Actuators are propagated by themselves, exactly or in steps as short as
// they need (core/dynamics/actuators.h), and so are bending modes (core/dynamics/bending.h), whatever their
// frequency; but the body feels them at three instants of a tick. From some frequency on these do not show
// what happens in between. The limits, as frequency times tick, are where flights still agree with CVODE,
// which steps as short as it has to (tests/verification/step_limits_test.cc; figures in core/README.md).
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/launcher.h"
#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Actuators of nozzles without mass: the highest that has been compared. 160 Hz with ticks of 10 ms.
inline constexpr double kActuatorLimit_rad = 10.0;
/// Of nozzles whose turning accelerates the body, by the acceleration at those three instants: 20 Hz.
inline constexpr double kHeavyActuatorLimit_rad = 1.25;
/// From this share of a limit on a case is flagged.
inline constexpr double kNearStepLimit = 0.8;
/// Bending modes: flagged beyond half the sampling frequency, below which nominal ones fly (AddBending). What
/// the autopilot then sees of one is its alias, as of a real one; what the body feels of it is still its own
/// motion.
inline constexpr double kModeLimit_rad = kPi / kNearStepLimit;

/// The part of a vehicle that comes nearest to its limit.
struct StepUse {
  double fraction = 0.0;  ///< of the limit; above 1: it is not resolved
  std::string part;       ///< "the actuators of stage 2 (80 Hz)"
  double limit_hz = 0.0;
};
StepUse GreatestStepUse(const LauncherPlant& plant, double tick_s);
/// The highest natural frequency of a stack's actuators and bending modes, rad/s.
double FastestPart(const LauncherPlant& plant, int stack);

/// Why a flight with these inputs and their plant cannot be computed, as a sentence; empty if it can.
std::string RefusalOf(const Vehicle& vehicle, const FlightInputs& inputs, const LauncherPlant& plant,
                      double tick_s);

/// Actuators of a nominal vehicle beyond their limit, by the path in its file.
std::vector<VehicleProblem> StepProblems(const Vehicle& vehicle, double tick_s);

}  // namespace dispersa
