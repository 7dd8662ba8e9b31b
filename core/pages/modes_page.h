// The bending modes of a vehicle as one self-contained page: frequency over propellant, and mode shapes, for
// each stack.
#pragma once

#include <string>
#include <vector>

#include "core/structure/bending_modes.h"

namespace dispersa {

std::string ModesPage(const Vehicle& vehicle, const std::vector<StackModes>& stacks);

/// The kind of the beam, in words.
std::string BeamText(const StructureBeam& beam);

}  // namespace dispersa
