// A requirement in words that programs compare and people read.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/statistics/limits.h"

namespace dispersa {

Limits LimitsOf(const Requirement& requirement);

/// Its limit without its plan: "pitch_error_peak_deg below 0.5", "... above ...", "... between ... and ...".
std::string LimitText(const Requirement& requirement);

/// In one line: what is compared to tell whether it was changed after the first case.
std::string RequirementLine(const Requirement& requirement);

}  // namespace dispersa
