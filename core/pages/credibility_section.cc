// What a campaign contributes to an assessment of credibility after NASA-STD-7009. The names of the factors
// are those of revision A and of revision B as remembered; revision B was not at hand.
#include <fmt/format.h>

#include <algorithm>

#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"

namespace dispersa {
namespace {

std::string CausesWords(const CampaignSummary& summary) {
  const auto explained = std::count_if(summary.drivers.begin(), summary.drivers.end(),
                                       [](const MetricDrivers& one) { return !one.drivers.empty(); });
  if (explained == 0) return "Too few flights, or no input with an effect: no cause is named.";
  return fmt::format("<a href=\"#causes\">Causes</a> name the inputs that explain the spread of {} metrics.",
                     explained);
}

std::string PedigreeWords(const CampaignSummary& summary) {
  const auto checked = std::count_if(summary.dispersions.begin(), summary.dispersions.end(),
                                     [](const DispersionSummary& one) { return one.consistent.has_value(); });
  const auto agreed =
      std::count_if(summary.dispersions.begin(), summary.dispersions.end(),
                    [](const DispersionSummary& one) { return one.consistent && *one.consistent; });
  return fmt::format(
      "<a href=\"#dispersions\">{} inputs</a> are dispersed by declared distributions; the draws of {} of {} "
      "that "
      "can be checked agree with them.",
      summary.dispersions.size(), agreed, checked);
}

std::string UncertaintyWords(const CampaignSummary& summary) {
  if (!IsIndependent(summary.sampling))
    return fmt::format("{} chosen points were flown; they show no probability.", summary.flown);
  return fmt::format(
      "{} flights with independent draws. Each requirement has its risk, each percentile its limits.",
      summary.flown);
}

}  // namespace

std::string CredibilitySection(const CampaignSummary& summary) {
  HtmlTable table("!Factor|Shown here|Not shown here because");
  table.Row({"Data pedigree",
             "All values of vehicle, reference and autopilot stand in <code>campaign.yaml</code>.",
             "Where the values come from is known to their authors alone."});
  table.Row({"Verification",
             fmt::format("The engine's sources are identified by {}.", Code(summary.engine.substr(0, 12))),
             "A campaign solves no problem with a known answer; the tests of dispersa do."});
  table.Row({"Validation", "Nothing.", "No flight is compared with measurements of the real vehicle."});
  table.Row({"Input pedigree", PedigreeWords(summary),
             "Whether a distribution fits the hardware is for its owner to show."});
  table.Row({"Uncertainty characterization", UncertaintyWords(summary),
             "What is <a href=\"#limits\">not modelled</a> has an unknown error, which is in no bound."});
  table.Row({"Results robustness", CausesWords(summary),
             "Assumptions that are not dispersed are not varied; <code>dispersa compare</code> shows their "
             "effect."});
  table.Row({"M&amp;S history (use history)",
             "The first page lists earlier attempts at this design in the same folder.",
             "Uses elsewhere leave no trace here."});
  table.Row({"M&amp;S process and product management",
             fmt::format("Campaign {}, flights {}. Every case can be flown again and compared by its bits.",
                         Code(summary.id.substr(0, 12)), Code(summary.flight_id.substr(0, 12))),
             "Reviews, qualifications and change control are kept outside."});
  return "<h2 id=\"credibility\">Credibility</h2>\n<p>The factors that NASA-STD-7009B names, from "
         "memory: its text was not at hand. This table is no assessment. It says what this campaign "
         "contributes "
         "to one.</p>\n" +
         table.Html();
}

}  // namespace dispersa
