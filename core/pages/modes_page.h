// The bending modes of a vehicle as one self-contained page: frequencies over the propellant and shapes, by
// stack.
#pragma once

#include <string>
#include <vector>

#include "core/structure/bending_modes.h"

namespace dispersa {

std::string ModesPage(const Vehicle& vehicle, const std::vector<StackModes>& stacks);

/// What kind of beam it is, in words.
std::string BeamText(const StructureBeam& beam);

}  // namespace dispersa
