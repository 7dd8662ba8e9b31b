// Verdicts for continuous integration.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"

namespace dispersa {

/// JUnit XML: a test case a requirement. Not met: a failure; not decided or incomplete: an error; a study's:
/// skipped, or a failure where a flown point violates it. Without requirements one test case for the flights.
std::string JUnitXml(const CampaignSummary& summary);

}  // namespace dispersa
