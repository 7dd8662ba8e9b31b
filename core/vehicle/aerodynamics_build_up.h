// Aerodynamic tables of a launch vehicle from its outer mould line.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// One table a stack. Table k is for stages k to the last: the profile from the nose tip to
/// vehicle.stages[k].bottom_station_m, on the cross-section and diameter of stage k.
///
/// Sum of components of a body of revolution (a: incidence; a': a up to 90 degrees, 180 - a beyond;
/// Jorgensen, NASA TN D-6996):
/// - CN = C_Na(M) / 2 sin 2a' cos(a'/2) + eta Cdc(M sin a) A_p / S sin^2 a. C_Na is slender-body theory plus
///   half of the excess of shock-expansion theory, from Mach 0.8 (nothing) to Mach 2 (all of the half). It is
///   constant above Mach 8. Tail first it is slender-body theory's. The cross-flow term acts at the centroid
///   of the planform.
/// - CA = CA0(M) cos^2 a' nose first, -CA180(M) cos^2 a' tail first.
/// - CA0: turbulent skin friction with roughness, pressure drag of nose, frustums and boat-tails, base drag
///   (drag.h). Power on: the nozzles' exits reduce the base by their area (Fleeman), or by half if the
///   vehicle gives no exit area.
/// - Pitch damping: slender-body theory, about the middle of the stack, the same at every Mach number.
/// - Roll damping: of skin friction only, since there are no fins.
///
/// Grid: Mach 0 to 20, incidence 0 to 180 degrees. Outside, the end value holds: at Mach 20 all but skin
/// friction has reached its hypersonic limit, and a launcher is above the sensible atmosphere.
///
/// Validity: fineness above 5, widening mould lines, incidence up to 30 degrees. Beyond 30 degrees sign and
/// size are right, no more. A boat-tail's negative lift is taken in full, as if its flow stayed attached.
/// Continuum flow, air without reactions, no plume effect on the body.
///
/// Accuracy: a reconstruction of a public three-stage launcher differs from Missile DATCOM's tables by -26 to
/// +22 % in CA, by -7 to +34 % in CN up to 30 degrees, and by 0 to 11 % of the length, aft, in the centre of
/// pressure (tests/verification/aero_public_tables_test.cc). Those tables were known when the half of the
/// carry-over was chosen. Pitch damping is about four times theirs. Theirs is what the force at the centre of
/// pressure alone would give.
///
/// Precondition: a profile that passes Problems(), so that it reaches every stage's bottom.
std::vector<AeroTable> BuildAerodynamics(const Vehicle& vehicle);

/// The vehicle's tables, or those built up. Dampings that a table lacks are those of the build-up, on the
/// table's reference area and length. If a table of the vehicle has two planes, all have: a body of
/// revolution has the same in both.
std::vector<AeroTable> AerodynamicsOf(const Vehicle& vehicle);
/// Whether AerodynamicsOf needs the profile.
bool NeedsProfile(const Vehicle& vehicle);

}  // namespace dispersa
