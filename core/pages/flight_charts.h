// Charts over time: the nominal flight, and how the dispersed ones spread about it.
#pragma once

#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/pages/histories.h"

namespace dispersa {

/// Figures of the nominal flight, each marked with the stages.
std::string NominalFigures(const History& nominal);

/// Figures of the percentile bands about the nominal. `kick_end_s`: the pitch-over is shown magnified till
/// somewhat later.
std::string EnvelopeFigures(const FlightHistories& histories, const CampaignSummary& summary,
                            double kick_end_s);

/// The worst cases that have a history, over the envelope of what made them worst.
std::string WorstFigures(const FlightHistories& histories, const CampaignSummary& summary);

}  // namespace dispersa
