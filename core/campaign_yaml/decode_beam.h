// A vehicle's `structure_beam` to the engine's struct.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/input_error.h"
#include "core/campaign_yaml/input_node.h"
#include "core/vehicle/structure_beam.h"

namespace dispersa {

/// `stages`: of the vehicle, for which the beam has one entry each; 0 if that is unknown. None if its table
/// could not be read, which was reported.
std::optional<StructureBeam> DecodeStructureBeam(const InputNode& node, const std::string& path,
                                                 std::size_t stages, std::vector<InputProblem>& problems);

}  // namespace dispersa
