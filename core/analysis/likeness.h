// Flights that cannot show a probability: they say no more together than one of them.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// Why two flights or more are no evidence of a share of flights: nothing varies between them, no part of
/// them reads what varies, or all are alike to the last bit. Empty: they may be evidence.
std::string WhyNoEvidence(const Campaign& campaign, const CaseColumns& cases);

}  // namespace dispersa
