// The data of the cases for the script of the page.
#pragma once

#include <cstddef>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// Limits the size of the page, so that it can be sent by mail.
inline constexpr std::size_t kAnsweringCases = 5000;

/// JSON for an element of the page: the metrics that charts show by case, the cases, and their values to six
/// digits. If there are more than kAnsweringCases cases, only those with the smallest and the largest values
/// of each metric.
std::string CaseData(const CampaignSummary& summary, const CaseColumns& cases);

}  // namespace dispersa
