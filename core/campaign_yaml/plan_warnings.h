// Warnings about requirements that are allowed but that no flight can show.
#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// The warnings about a valid campaign. `root` is the tree that it was read from, for the places in the file.
std::vector<InputProblem> PlanWarnings(const Campaign& campaign, const InputNode& root);

}  // namespace dispersa
