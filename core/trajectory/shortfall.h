// The reasons why a target was missed, in words for the user.
#pragma once

#include <string>

#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// One sentence says how near the best program came. One more sentence follows for each cause: a violated
/// constraint, a variable at its bound that altitude and angle need, or the vehicle's energy. Energy is given
/// as the range of speeds at the target's altitude and angle, over the bounds of the launch azimuth.
std::string DescribeShortfall(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const OptimizationResult& result);

}  // namespace dispersa
