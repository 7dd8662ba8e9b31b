// Charts of the distribution of a metric over the cases.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// Two figures for a metric, with the limits of its requirements. The first is the histogram. The second is
/// the share of cases beyond each value, on a logarithmic scale; lost flights count as beyond any value. If
/// no case defines the metric, a sentence.
std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary,
                                const CaseColumns& cases);
/// The name of their place on the page.
inline std::string DistributionId(const std::string& metric) { return "of-" + metric; }

/// Where the completed cases come down: down-range against cross-range.
std::string ImpactFigures(const CampaignSummary& summary, const CaseColumns& cases);

/// The injection of the completed cases: altitude error against velocity error, apogee against perigee, and
/// the errors of inclination and semi-major axis. Errors have their target, and all have limits and
/// ellipses of covariance. A pair that no flight defines is left out.
std::string InjectionFigures(const CampaignSummary& summary, const CaseColumns& cases);

}  // namespace dispersa
