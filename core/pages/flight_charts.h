// Charts over time: the nominal flight, and the spread of the dispersed flights about it.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/pages/histories.h"

namespace dispersa {

/// Figures of the nominal flight, with its stages marked.
std::string NominalFigures(const History& nominal);

/// Figures of the percentile bands about the nominal flight. The pitch-over has an enlarged figure, to
/// somewhat later than `kick_end_s`.
std::string EnvelopeFigures(const FlightHistories& histories, const CampaignSummary& summary,
                            double kick_end_s);

/// The worst cases that have a history. Each is drawn over the envelope of the quantity in which it is worst.
std::string WorstFigures(const FlightHistories& histories, const CampaignSummary& summary);

}  // namespace dispersa
