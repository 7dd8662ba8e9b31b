// report.html: one file for a review board, readable offline and on paper.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/campaign/campaign.h"
#include "core/pages/histories.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// The whole page. Its numbers are those of summary.json, rounded for reading. It holds no date, no time of
/// computation, no path and no name of a machine.
std::string ReportPage(const Campaign& campaign, const CampaignSummary& summary, const CaseColumns& cases,
                       const FlightHistories& histories);

}  // namespace dispersa
