// What a campaign requires and cannot show: legal, and never of use.
#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Of a valid campaign and the tree that it was read from, each at its place in the file.
std::vector<InputProblem> PlanWarnings(const Campaign& campaign, const InputNode& root);

}  // namespace dispersa
