// A requirement's limit without its plan.
#pragma once

#include <string>

#include "core/campaign/campaign.h"

namespace dispersa {

/// "pitch_error_peak_deg below 0.5", "... above ...", "... between ... and ...".
std::string LimitText(const Requirement& requirement);

}  // namespace dispersa
