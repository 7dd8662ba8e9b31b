// The frequencies that the engine's step resolves, and the dispersed vehicles that cannot be flown.
//
// A step is one tick of the autopilot. Actuators are propagated by themselves, exactly or in steps as short
// as they need (core/dynamics/actuators.h). So are bending modes of any frequency (core/dynamics/bending.h).
// But the body feels them at three instants of a tick: above some frequency these do not show the motion in
// between. The limits are given as frequency times tick. Up to them flights agree with CVODE, which chooses
// its own steps (tests/verification/step_limits_test.cc; figures in core/README.md).
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
/// Limit for nozzles that accelerate the body when they turn, by the acceleration at those three instants: 20
/// Hz.
inline constexpr double kHeavyActuatorLimit_rad = 1.25;
/// A body that nothing holds turns by no more than this in a step: 5 Hz of spin with steps of 5 ms, 12 Hz
/// with 2 ms. There the cone of a torque-free body errs by 0.7 of its angle in a hundred turns. The error
/// falls with the third power of the step: 0.05 at 5 Hz with steps of 2 ms
/// (tests/verification/free_flight_test.cc).
inline constexpr double kTurnLimit_rad = 0.16;
/// From this share of a limit on a case is flagged.
inline constexpr double kNearStepLimit = 0.8;
/// Bending modes are flagged above half the sampling frequency; nominal modes stay below it (AddBending).
/// Above it the autopilot sees a mode's alias, as with a real one. The body still feels the mode's own
/// motion.
inline constexpr double kModeLimit_rad = kPi / kNearStepLimit;

/// The part of a vehicle that comes nearest to its limit.
struct StepUse {
  double fraction = 0.0;  ///< of the limit (above 1: not resolved)
  std::string part;       ///< "the actuators of stage 2 (80 Hz)"
  double limit_hz = 0.0;
};
StepUse GreatestStepUse(const LauncherPlant& plant, double tick_s);
/// The highest natural frequency of a stack's actuators and bending modes, rad/s.
double FastestPart(const LauncherPlant& plant, int stack);

/// Reason, as a sentence, why a flight with these inputs (the parts' `set`) and their plant cannot be
/// computed; empty if it can.
std::string RefusalOf(const FlightParts& parts, const LauncherPlant& plant, double tick_s);

/// Actuators of a nominal vehicle beyond their limit, by the path in its file.
std::vector<StructProblem> StepProblems(const Vehicle& vehicle, double tick_s);

}  // namespace dispersa
