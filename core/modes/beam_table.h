// The table of the bending modes of a stack's beam (core/structure).
#pragma once

#include <memory>

#include "core/modes/mode_table.h"
#include "core/structure/bending_modes.h"

namespace dispersa {

class BendingPlaces;  ///< places of a stack's mesh, found once for all masses (bending_places.h)

struct BeamTable : ModeTable {
  std::shared_ptr<const BendingPlaces> places;
};

/// Number of modes of a stack that fly: at most the beam's flown_modes. It ends before the first mode with a
/// frequency above `highest_rad_s` at any time of the burn.
int ModesBelow(const Vehicle& vehicle, const StackModes& stack, double highest_rad_s);

/// The table of the first `modes` modes of one stack.
///
/// `shortening` of modes j and k: the integral of w_j' w_k' over the beam, weighted with the share of the
/// mass that lies ahead. The axial force F carried by the stack lowers the stiffness by F times that (the
/// potential energy of a compressed beam, e.g. S. Timoshenko and J. Gere, "Theory of Elastic
/// Stability", 1.11; drag taken as carried like thrust). The thrust of boosters enters the beam at their
/// link, so the beam behind carries so much less: that times the shortening `behind` the link, without the
/// weight.
///
/// `near`: the table of the same stack with its nominal masses, or null. It saves time where the mesh is the
/// same.
BeamTable BuildBeamTable(const Vehicle& vehicle, const StackModes& stack, const LoadTable& loads, int modes,
                         const BeamTable* near = nullptr);

}  // namespace dispersa
