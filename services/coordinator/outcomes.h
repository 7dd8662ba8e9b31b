// What a coordinator keeps of a campaign's report.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "services/coordinator/catalogue.h"
#include "services/web/campaign_row.h"

namespace dispersa {

/// The first kMaxOutcomes requirements, each with the verdict that stands, and every load check that has
/// failures.
std::vector<RequirementOutcome> OutcomesOf(const CampaignSummary& summary);

/// The verdict of a campaign that has ended, in words; empty: it has none. `problem` has why others ended.
std::string VerdictWords(const CatalogueEntry& entry);

}  // namespace dispersa
