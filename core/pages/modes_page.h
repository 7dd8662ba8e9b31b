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
/// How fine the mesh of a plane is, from 0 ("": a table's): "64 elements; twice as long, they change no mode
/// by more than 0.02 %".
std::string MeshText(const StackModes& stack, std::size_t plane);

}  // namespace dispersa
