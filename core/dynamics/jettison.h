// What is jettisoned from a vehicle in flight: when, and what that does to its state.
#pragma once

#include "core/dynamics/launcher.h"

namespace dispersa {

/// The stack as it is without what has been jettisoned (bits of LauncherPhase::jettisoned, the boosters'
/// among them), and without propellant of boosters.
StackMass MassOf(const LauncherPlant& plant, int stack, unsigned jettisoned);

/// Those with the propellant on board: `since_ignition_s` of the first stage says how much the boosters have.
MassProperties MassesOn(const LauncherPlant& plant, int stack, unsigned jettisoned, double propellant_kg,
                        double since_ignition_s);

/// What jettisons depend on.
struct JettisonSight {
  double time_s = 0.0;  ///< since lift-off
  double altitude_m = 0.0;
  double density_kg_m3 = 0.0;
  double ground_speed_m_s = 0.0;  ///< over the rotating Earth
};

/// Below this altitude a heat flux is no free-molecular one: it is not looked at.
inline constexpr double kFreeMolecularAltitude_m = 80e3;

/// The free-molecular heating of a surface across the flow, rho v³ / 2, W/m²: what user's manuals limit after
/// the fairing has gone (1135 W/m² of Ariane 5, Vega and others), with an accommodation coefficient of 1.
double HeatFlux(const JettisonSight& sight);

/// Those that are due, as bits; those that went before, or that the stack does not carry any more, are not.
unsigned DueJettisons(const LauncherPlant& plant, int stack, unsigned jettisoned, const JettisonSight& sight);

/// `state` after more has been jettisoned: it follows the centre of gravity, which jumps. `propellant_kg`: of
/// the stack's lowest stage; `since_ignition_s`: of the first stage, if that is it.
RigidBodyState AfterJettison(const LauncherPlant& plant, int stack, unsigned before, unsigned after,
                             double propellant_kg, double since_ignition_s, const RigidBodyState& state);

}  // namespace dispersa
