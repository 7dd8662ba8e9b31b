// A summary for merge requests and chat: what reviewers read first, as text.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"

namespace dispersa {

/// CommonMark with tables: the standing verdict, its notes and warnings, the requirements, the worst cases
/// with the commands that fly them again, the key statistics.
std::string MarkdownReport(const CampaignSummary& summary);

}  // namespace dispersa
