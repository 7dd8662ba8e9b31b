// Ends of burns that the flight computer finds by the speed: cut_off: {at: inertial_velocity} and {at:
// target}.
#pragma once

#include "core/vehicle/motor.h"

namespace dispersa {

/// Whether a speed ends a motor's burn.
inline bool EndsAtSpeed(const Motor& motor) {
  return motor.cut_off == CutOff::kAtVelocity || motor.cut_off == CutOff::kAtTarget;
}

/// Whether a command ends a motor's burn, if its propellant lasts.
inline bool EndsByCommand(const Motor& motor) { return motor.cut_off != CutOff::kAtDepletion; }

/// Whether only a flight tells when a motor's burn ends, because of a speed or of guidance.
inline bool EndsInFlight(const Motor& motor) {
  return EndsAtSpeed(motor) || motor.cut_off == CutOff::kByGuidance;
}

/// By how much the flight computer commands a cut-off before the instant at which the burn should end. The
/// thrust decays linearly in `tail_off_s` after the command, so the burn has the impulse of one that ends at
/// that instant at once. It knows the nominal decay only.
inline double CutOffLead(const Motor& motor) { return 0.5 * motor.tail_off_s; }

/// The inertial speed (m/s) at which the engine is cut off, at a distance from the Earth's centre and a
/// geodetic altitude. For `at: target` it is that of an orbit with the target's energy about a point mass.
/// Infinite if no target has been given (core/trajectory/aim.h). Precondition: EndsAtSpeed(motor).
double CutOffSpeed(const Motor& motor, double radius_m, double altitude_m);
/// How fast that speed changes (m/s²) while the radius grows by `climb_m_s`.
double CutOffSpeedRate(const Motor& motor, double radius_m, double altitude_m, double climb_m_s);

}  // namespace dispersa
