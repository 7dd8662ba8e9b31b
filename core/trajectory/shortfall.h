// Why a target was missed, in words for the user.
#pragma once

#include <string>

#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// One sentence on how far the best program got, then one for each thing that stopped it: a constraint that
/// it breaks, a variable at the end of its bounds without which altitude and angle cannot be had, the
/// vehicle's energy (the range of speeds that it has at the target's altitude and angle over the bounds of
/// the launch azimuth).
std::string DescribeShortfall(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const OptimizationResult& result);

}  // namespace dispersa
