// Verdicts for continuous integration.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"

namespace dispersa {

/// JUnit XML with one test case for each requirement. Not met: a failure. Undecided, incomplete or not
/// evidence: an error. In a study: skipped, or a failure if a flown point violates it. Without requirements:
/// one test case for the flights.
std::string JUnitXml(const CampaignSummary& summary);

}  // namespace dispersa
