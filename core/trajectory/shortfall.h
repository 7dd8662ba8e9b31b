// Why a target was missed, in words for the user.
#pragma once

#include <string>

#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// One sentence on how near the best program came, then one for each cause: a constraint that it breaks, a
/// variable at the end of its bounds that altitude and angle need, the vehicle's energy (its range of speeds
/// at the target's altitude and angle over the bounds of the launch azimuth).
std::string DescribeShortfall(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const OptimizationResult& result);

}  // namespace dispersa
