// Charts over time: the nominal flight, and the spread of the dispersed flights about it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/pages/histories.h"

namespace dispersa {

/// Figures of the nominal flight, with its stages marked: of what the envelope does not show.
std::string NominalFigures(const History& nominal);

/// The bands of one quantity as a figure.
struct BandView {
  const char* column;  ///< of BandColumnNames()
  const char* label;
  double factor = 1.0;  ///< from the unit of the column to the unit of the label
  bool deviation =
      false;  ///< difference from the nominal flight, beside which the spread would be too small to see
  std::optional<double> from_s = {}, to_s = {};
  bool program = false;        ///< with the pitch program
  bool in_air = false;         ///< only where the air is dense enough for incidence to have an effect
  const char* peak = nullptr;  ///< the metric of its largest magnitude, whose limits are drawn
  int width = 520;
  std::string style = "";  ///< of the figure
};
/// Empty if no flight defines the quantity. The bands must hold it, and "qbar_pa".
std::string BandFigure(const BandView& view, const FlightHistories& histories, const CampaignSummary& summary,
                       const std::string& caption);

/// Figures of the percentile bands about the nominal flight. The pitch-over has an enlarged figure, to
/// somewhat later than `kick_end_s`.
std::string EnvelopeFigures(const FlightHistories& histories, const CampaignSummary& summary,
                            double kick_end_s);

/// The quantity whose peak the metric is in a flight with a history, and when: "yaw deflection at 38 s".
/// Empty: unknown, or no peak.
std::string WorstQuantity(const std::string& metric, std::uint64_t case_index,
                          const FlightHistories& histories);

/// The worst cases that have a history. Each is drawn over the envelope of the quantity in which it is worst.
std::string WorstFigures(const FlightHistories& histories, const CampaignSummary& summary);

}  // namespace dispersa
