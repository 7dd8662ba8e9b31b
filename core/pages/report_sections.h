// The parts of report.html that are text and tables.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/campaign/campaign.h"
#include "core/pages/histories.h"

namespace dispersa {

/// What stands, requirement by requirement. All of it is between the marks of what differs from run to run.
std::string FirstPage(const Campaign& campaign, const CampaignSummary& summary);
std::string RequirementsSection(const CampaignSummary& summary);
std::string OutcomesSection(const CampaignSummary& summary);
std::string WorstCasesSection(const CampaignSummary& summary, const FlightHistories& histories);
std::string CausesSection(const CampaignSummary& summary);
std::string StatisticsSection(const CampaignSummary& summary);
/// A table of standard deviations and correlations, and one of the containments.
std::string InjectionSection(const InjectionSummary& injection);
std::string DispersionsSection(const CampaignSummary& summary);
std::string NotModelledSection(const Campaign& campaign);
/// What the campaign shows of each credibility factor of NASA-STD-7009, and what it does not.
std::string CredibilitySection(const CampaignSummary& summary);
std::string ProvenanceSection(const Campaign& campaign, const CampaignSummary& summary);

}  // namespace dispersa
