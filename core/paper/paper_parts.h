// Parts of the paper's page: for each a claim of the paper, what the flights show, and what is drawn of it.
#pragma once

#include <string>
#include <vector>

#include "core/pages/html_parts.h"
#include "core/paper/paper_study.h"

namespace dispersa {

enum class PaperVerdict { kReproduced, kInPart, kNotReproduced, kNoClaim };

/// A row of the page's table, and what stands below it. Texts are HTML whose numbers come from the study.
struct PaperPart {
  std::string id;     ///< "fig5"
  std::string title;  ///< "Fig. 5: the choice of P_n"
  std::string claim, found, difference;
  PaperVerdict verdict = PaperVerdict::kNoClaim;
  std::string shown_by;  ///< links to files beside the page
  std::string shown = {};
};
// In the order of the page.
std::vector<PaperPart> TrajectoryParts(const PaperStudy& study);  ///< Tables 1 to 3, Figs. 2 and 3
PaperPart PnPart(const PaperStudy& study);                        ///< Fig. 5
std::vector<PaperPart> FlownParts(const PaperStudy& study);       ///< Figs. 6 to 10
std::vector<PaperPart> LawParts(const PaperStudy& study);         ///< other laws, margins, V, completions

/// A link to a file of the output folder.
inline std::string PaperLink(const std::string& file, const std::string& text) {
  return "<a href=\"" + file + "\">" + text + "</a>";
}
inline std::string ReportLink(const std::string& campaign) {
  return PaperLink(campaign + "/report.html", campaign);
}
inline std::string Figures(const std::string& figures) {
  return "<div class=\"figures\">\n" + figures + "</div>\n";
}

/// "0.0123°"
std::string Degrees(double value);
inline constexpr char kRms[] = "pitch_error_rms_deg", kPeak[] = "pitch_error_peak_deg",
                      kCycle[] = "deflection_limit_cycle_deg";
/// Of a metric in degrees, over the completed flights.
struct MetricDigest {
  double p50 = 0.0, max = 0.0;
};
MetricDigest Digested(const CaseColumns& cases, const std::string& metric);
/// A row whose middle cells digest the flights.
using Cells = std::vector<std::string>;
inline const std::string kDigestTitles =
    "#flights|#lost|#RMS, median|#RMS, largest|#peak, median|#peak, largest|#limit cycle, largest";
void DigestRow(HtmlTable& table, Cells before, const CaseColumns& cases, const Cells& after);

}  // namespace dispersa
