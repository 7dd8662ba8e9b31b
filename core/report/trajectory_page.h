// What `dispersa optimize` found, as one self-contained page: Table 2 and Figures 2 and 3 of the paper, the
// constraints, and how the search went.
#pragma once

#include <optional>
#include <string>

#include "core/trajectory/optimize.h"

namespace dispersa {

/// `flown`: the injection errors of the closed-loop nominal flight of the reference, if it was flown.
std::string TrajectoryPage(const OptimizationResult& result, const std::optional<OrbitErrors>& flown);

/// Says of each enforced limit that is ten times the value or more that it does not bind; empty if none.
std::string LimitsThatDoNotBind(const Reference& reference);

}  // namespace dispersa
