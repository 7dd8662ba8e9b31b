// The cross-sections at which a stack's bending moment is looked at.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

struct LoadStations {
  std::vector<double> station_m;  ///< the scouts first
  /// At one of the scouts every moment of the family is at least this part of its largest.
  double scouts_see = 0.0;
};

/// Stations at one of which every moment of a family is at least 1 - kMissedMoment of its largest along the
/// stack, and at most `most` of them (then those at which the most moments are). The first kScoutStations of
/// them tell whether the others need a look. The family: the rigid body under the normal force and a side
/// force at the pivot in any proportion, at five levels of propellant, the centre of pressure where
/// slender-body theory has it and up to a tenth of the length aft and ahead of that. Boosters add a side
/// force of their nozzles and a couple, each with any other of these in any proportion. The stack without
/// them follows from their separation on. A moment is a smooth function of the station but for bodies that
/// are fixed at one and for ends of masses, so candidates are even and these. Precondition:
/// HasSectionLoads().
LoadStations ChooseLoadStations(const Vehicle& vehicle, int stage, std::size_t most);

/// Of a moment's largest value.
inline constexpr double kMissedMoment = 1e-3;

}  // namespace dispersa
