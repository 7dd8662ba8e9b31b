// The causes of a report: what drives each key metric, and what failing flights have in common.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/pages/glossary.h"
#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string Share(double index) { return fmt::format("{:.1f} %", 100.0 * index); }

/// A row of the tornado: names and numbers, and below them a bar as wide as the screen gives, with its
/// interval.
std::string Bar(const Driver& driver) {
  std::string names = InputNames(driver.key, driver.input);
  for (const std::string& same : driver.same_as) names += " = <code>" + HtmlText(same) + "</code>";
  std::string correlated;
  for (const std::string& other : driver.correlated_with)
    correlated +=
        (correlated.empty() ? ", drawn together with <code>" : ", <code>") + HtmlText(other) + "</code>";
  return fmt::format(
      "<li><span class=\"cause\">{} <span class=\"soft\">by {}{}{}</span></span><span class=\"n\"><b>{}</b> "
      "<span class=\"soft\">{} to {}</span></span><svg viewBox=\"0 0 1000 10\" preserveAspectRatio=\"none\" "
      "aria-hidden=\"true\"><rect class=\"track\" width=\"1000\" height=\"10\"/><rect class=\"bar\" "
      "width=\"{:.1f}\" "
      "height=\"10\"/><path class=\"whisker\" d=\"M{:.1f} 5H{:.1f}\"/></svg></li>\n",
      names, HtmlText(driver.feature),
      std::isfinite(driver.partial) ? ", partial rank correlation " + FixedText(driver.partial, 2)
                                    : std::string(),
      correlated, Share(driver.index), Share(driver.low), Share(driver.high), 1000.0 * driver.index,
      1000.0 * driver.low, 1000.0 * driver.high);
}

/// Empty if nothing tells failing flights from the others.
std::string FailurePart(const FailureDrivers& requirement) {
  if (requirement.drivers.empty() && requirement.pairs.empty()) return "";
  std::string html =
      fmt::format("<h3>{} of {}: {} {}</h3>\n", requirement.nearest ? "Nearest to failing" : "Failing",
                  HtmlText(DescribeMetric(requirement.metric).title), requirement.flights,
                  requirement.flights == 1 ? "flight" : "flights");
  HtmlTable table("!Input|Feature|Among them|#p|#" +
                  Term("expected false alarms", "Expected false alarms in the list so far"));
  constexpr std::size_t kShown = 5;
  for (std::size_t i = 0; i < std::min(kShown, requirement.drivers.size()); ++i) {
    const FailureDriver& driver = requirement.drivers[i];
    table.Row({InputNames(driver.key, driver.input), HtmlText(driver.feature),
               driver.larger ? "larger" : "smaller", HtmlText(PValueText(driver.p)),
               Share(driver.false_discovery_rate)});
  }
  html += table.Html("causes");
  if (requirement.drivers.size() > kShown)
    html += fmt::format("<p class=\"soft\">The first {} of {}; <code>summary.json</code> has all.</p>\n",
                        kShown, requirement.drivers.size());
  if (requirement.pairs.empty()) return html;
  html +=
      "<p>Combinations: two inputs that belong together among the failing flights and not among the "
      "others.</p>\n";
  HtmlTable pairs("!Inputs|Among the failing flights|#Rank correlation|#p|#" +
                  Term("expected false alarms", "Expected false alarms in the list so far"));
  for (const FailurePair& pair : requirement.pairs) {
    pairs.Row({InputNames(pair.first_key, pair.first) + " by " + HtmlText(pair.first_feature) + " and " +
                   InputNames(pair.second_key, pair.second) + " by " + HtmlText(pair.second_feature),
               pair.correlation > 0.0 ? "large together" : "one is large where the other is small",
               FixedText(pair.correlation, 2), HtmlText(PValueText(pair.p)),
               Share(pair.false_discovery_rate)});
  }
  return html + pairs.Html("causes");
}

}  // namespace

std::string CausesSection(const CampaignSummary& summary) {
  std::string html =
      "<h2 id=\"causes\">Causes</h2>\n<p>At most five inputs for each metric. The " +
      Term("index, share", "share") +
      " is how much of the metric’s variance an input explains when the inputs above it are known, with its "
      "interval of 95 %. A magnitude and its direction (" +
      Term("clock angle") +
      ") count together (“along”). “by” names the function of the input that ranks the flights best. Inputs "
      "that rank the flights alike (“=”) cannot be told apart. The shares leave out interaction and "
      "noise.</p>\n<div class=\"drivers\">\n";
  bool any = false;
  for (const MetricDrivers& metric : summary.drivers) {
    if (metric.drivers.empty()) continue;
    any = true;
    html += "<div><h3>" + HtmlText(DescribeMetric(metric.metric).title) + "</h3>\n";
    html += "<ol class=\"tornado\">\n";
    for (const Driver& driver : metric.drivers) html += Bar(driver);
    html += "</ol></div>\n";
  }
  html += "</div>\n";
  if (!any) html += "<p>Fewer than 30 completed flights, or nothing that varies: no cause can be told.</p>\n";
  std::set<std::string> seen;  // several limits of a metric have the same flights nearest to them
  for (const FailureDrivers& requirement : summary.failure_drivers) {
    const std::string part = FailurePart(requirement);
    if (seen.insert(part).second) html += part;
  }
  return html;
}

}  // namespace dispersa
