// How a metric is distributed over the cases.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// Two figures for a metric: its histogram, and the share of cases beyond each value on a logarithmic scale
/// (lost flights are beyond any), with the limits of its requirements. A sentence if no case defines it.
std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary,
                                const CaseColumns& cases);

/// The injection of the completed cases: altitude against velocity error, and apogee against perigee.
std::string InjectionFigures(const CampaignSummary& summary, const CaseColumns& cases);

}  // namespace dispersa
