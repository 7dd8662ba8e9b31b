// What the page's script knows of the cases.
#pragma once

#include <cstddef>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// A page stays small enough to be sent by mail.
inline constexpr std::size_t kAnsweringCases = 5000;

/// JSON for an element of the page: the metrics that charts show by case, the cases, and their values to six
/// digits. Of more than kAnsweringCases those with the least and the largest values of each metric.
std::string CaseData(const CampaignSummary& summary, const CaseColumns& cases);

}  // namespace dispersa
