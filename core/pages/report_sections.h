// The parts of report.html that are text and tables.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/campaign/campaign.h"
#include "core/pages/histories.h"

namespace dispersa {

/// The verdict that stands, for each requirement. This and GlanceSection() are between the marks `run:begin`
/// and `run:end`, because they depend on the run.
std::string FirstPage(const Campaign& campaign, const CampaignSummary& summary);
std::string RequirementsSection(const CampaignSummary& summary);
std::string OutcomesSection(const CampaignSummary& summary);
/// "stage 1 burnout", "jettison: fairing", as HTML.
std::string EventWords(const std::string& name, const Vehicle& vehicle);
/// The vehicle, the nominal ascent, and the requirement with the least margin with what drives it.
std::string GlanceSection(const Campaign& campaign, const CampaignSummary& summary,
                          const FlightHistories& histories);
/// Nothing for results without events, which are of an older release.
std::string EventsSection(const Campaign& campaign, const CampaignSummary& summary);
std::string WorstCasesSection(const CampaignSummary& summary, const FlightHistories& histories);
std::string CausesSection(const CampaignSummary& summary);
std::string StatisticsSection(const CampaignSummary& summary);
/// A table of standard deviations and correlations, and one of the containments.
std::string InjectionSection(const InjectionSummary& injection);
/// Each input as declared and as drawn; the section has it under its heading.
std::string DispersionsTable(const CampaignSummary& summary);
std::string DispersionsSection(const CampaignSummary& summary);
std::string NotModelledSection(const Campaign& campaign);
/// The evidence of the campaign for each credibility factor of NASA-STD-7009, and the gaps.
std::string CredibilitySection(const CampaignSummary& summary);
std::string ProvenanceSection(const Campaign& campaign, const CampaignSummary& summary);

}  // namespace dispersa
