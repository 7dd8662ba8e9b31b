// Bodies that are jettisoned in flight: when they are due, and the state afterwards.
#pragma once

#include "core/dynamics/launcher.h"

namespace dispersa {

/// The stack as it is without what has been jettisoned (bits of LauncherPhase::jettisoned, the boosters'
/// among them), and without propellant of boosters.
StackMass MassOf(const LauncherPlant& plant, int stack, unsigned jettisoned);

/// Those with the propellant on board: `since_ignition_s` of the first stage says how much the boosters have.
MassProperties MassesOn(const LauncherPlant& plant, int stack, unsigned jettisoned, double propellant_kg,
                        double since_ignition_s);

/// Mass times place across the body's axis, of a stack with so much propellant and without boosters.
Vector3 LateralMoment(const LauncherStack& stack, double propellant_kg);

/// Values on which jettisons depend.
struct JettisonSight {
  double time_s = 0.0;  ///< since lift-off
  double altitude_m = 0.0;
  double density_kg_m3 = 0.0;
  double ground_speed_m_s = 0.0;  ///< over the rotating Earth
};

/// The jettisons that are due, as bits. Earlier ones, and those that the stack no longer carries, are left
/// out.
unsigned DueJettisons(const LauncherPlant& plant, int stack, unsigned jettisoned, const JettisonSight& sight);

/// `state` after further jettisons: it moves with the jump of the centre of gravity. `propellant_kg` is that
/// of the stack's lowest stage. `since_ignition_s` is that of the first stage, if it is the lowest.
RigidBodyState AfterJettison(const LauncherPlant& plant, int stack, unsigned before, unsigned after,
                             double propellant_kg, double since_ignition_s, const RigidBodyState& state);

/// Adds the bending of the stack below to the body above at a separation. Centre of gravity, attitude,
/// momentum and angular momentum become those that its masses had in the modes. `modal`: coordinates of the
/// burnt stack, as in the state of a launcher (kModalState). The body itself is straight afterwards.
void TakeAlong(const LauncherStack& below, unsigned jettisoned, const double* modal, RigidBodyState& above);

/// Changes the bending of a stack when it jettisons bodies (bits of LauncherPhase::jettisoned before and
/// after). The remaining stack takes over momentum as above and bends on. `modal` becomes the coordinates and
/// rates of the lighter stack's modes at that instant. Modes that do not fly get none.
void LetGoBent(const LauncherStack& stack, unsigned before, unsigned after, double propellant_kg,
               double* modal, RigidBodyState& left);

}  // namespace dispersa
