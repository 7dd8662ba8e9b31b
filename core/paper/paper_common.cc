#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/paper/paper_sections.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"
#include "core/statistics/percentiles.h"
#include "core/statistics/summary.h"

namespace dispersa {

std::string PaperFindings(const std::string& claim, const std::string& found, const std::string& difference) {
  std::string html = "<dl class=\"findings\">\n<dt>The paper</dt><dd>" + claim + "</dd>\n<dt>Found</dt><dd>" +
                     found + "</dd>\n";
  if (!difference.empty()) html += "<dt>Difference</dt><dd>" + difference + "</dd>\n";
  return html + "</dl>\n";
}

std::string PaperSource(const PaperStudy& study, const std::vector<std::string>& names) {
  std::string html = "<p class=\"soft source\">";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) html += "<br>\n";
    const auto found = study.campaigns.find(names[i]);
    std::string how = "the nominal flight";
    if (found != study.campaigns.end()) {
      const Campaign& campaign = found->second.campaign;
      how = fmt::format("{} flights of {} ({}, seed {})", found->second.flights.cases.rows(),
                        campaign.sampling.cases, SamplingMethodTitle(campaign.sampling.method),
                        campaign.sampling.seed);
    }
    html += fmt::format("{}: <code>dispersa run campaigns/{}.yaml</code>", how, names[i]);
  }
  return html + "</p>\n";
}

std::string Degrees(double value) {
  if (!std::isfinite(value)) return "–";
  const double magnitude = std::fabs(value);
  return fmt::format("{:.{}f}°", value, magnitude < 0.1 ? 4 : magnitude < 10.0 ? 3 : 1);
}

MetricDigest Digested(const CaseColumns& cases, const std::string& metric) {
  const std::vector<double> sorted = SortedFinite(CompletedValues(cases, metric));
  MetricDigest digest{cases.rows(), LostCount(cases), Quantile(sorted, 0.5), Quantile(sorted, 1.0), "–"};
  for (const Percentile& percentile : Percentiles(sorted)) {
    if (percentile.name != "p99") continue;
    if (std::isfinite(percentile.estimate)) {
      digest.p99 = Degrees(percentile.estimate);
    } else if (std::isfinite(percentile.limits.lower)) {
      digest.p99 = "≥ " + Degrees(percentile.limits.lower);
    }
  }
  return digest;
}

}  // namespace dispersa
