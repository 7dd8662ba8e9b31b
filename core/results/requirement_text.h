// A requirement in words that programs compare and people read.
#pragma once

#include <optional>
#include <string>

#include "core/campaign/campaign.h"
#include "core/statistics/limits.h"

namespace dispersa {

Limits LimitsOf(const Requirement& requirement);

/// Its limit without its plan: "pitch_error_peak_deg below 0.5", "... above ...", "... between ... and ...".
std::string LimitText(const Requirement& requirement);

/// In one line: what is compared to tell whether it was changed after the first case.
std::string RequirementLine(const Requirement& requirement);

/// Such a line back: what decides the requirement, and not its names. None of a line that is none.
std::optional<Requirement> RequirementOfLine(const std::string& line);
/// Such a line for people: "pitch_error_peak_deg below 0.5 for 99.73 % of flights at 10 % risk". A line that
/// is none stays as it is.
std::string LineWords(const std::string& line);

}  // namespace dispersa
