// Names and properties of sampling methods, and dispersions in words.
#pragma once

#include <string>

#include "core/campaign/campaign.h"

namespace dispersa {

/// "monte_carlo", "latin_hypercube", ... as in the campaign file.
const char* SamplingMethodName(SamplingMethod method);
/// "Monte Carlo", "Latin hypercube", ...
const char* SamplingMethodTitle(SamplingMethod method);
/// The design enumerates its points: corners, one at a time, grid, list.
bool IsEnumerated(SamplingMethod method);

}  // namespace dispersa
