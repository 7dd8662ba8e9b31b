// The causes of a report: what drives each key metric, and what failing flights have in common.
#include <fmt/format.h>

#include "core/report/html_parts.h"
#include "core/report/metric_catalogue.h"
#include "core/report/report_sections.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

/// An index from 0 to 1 as a bar with its interval.
std::string Bar(const Driver& driver) {
  constexpr double kWidth = 200.0;
  return fmt::format(
      "<svg class=\"tornado\" viewBox=\"0 0 {0:.0f} 12\" width=\"{0:.0f}\" height=\"12\" role=\"img\" "
      "aria-label=\"{1}, {2} to {3}\"><rect class=\"bar\" x=\"0\" y=\"2\" width=\"{4:.1f}\" "
      "height=\"8\"/><path "
      "class=\"axis\" d=\"M{5:.1f} 6H{6:.1f}M{5:.1f} 3V9M{6:.1f} 3V9\"/></svg>",
      kWidth, ReadableText(driver.index), ReadableText(driver.low), ReadableText(driver.high),
      kWidth * driver.index, kWidth * driver.low, kWidth * driver.high);
}

std::string Share(double index) { return fmt::format("{:.1f} %", 100.0 * index); }

}  // namespace

std::string CausesSection(const CampaignSummary& summary) {
  std::string html =
      "<h2 id=\"causes\">Causes</h2>\n<p>First-order Sobol indices from the flown cases: the share of a "
      "metric’s "
      "variance over the completed flights that each input explains by itself, signed, symmetric or "
      "circular, with "
      "its interval of 95 %. The feature is the function of the input that ranks the flights best; “along” "
      "is a "
      "magnitude in a direction. The partial rank correlation holds the other inputs. What the shares leave "
      "is "
      "interaction and noise.</p>\n";
  bool any = false;
  for (const MetricDrivers& metric : summary.drivers) {
    if (metric.drivers.empty()) continue;
    any = true;
    html += "<h3>" + HtmlText(DescribeMetric(metric.metric).title) + "</h3>\n";
    HtmlTable table({{"Input"}, {"Feature"}, {"Share", true}, {"Interval", true}, {"Partial", true}, {""}});
    for (const Driver& driver : metric.drivers) {
      table.Row({"<code>" + HtmlText(driver.input) + "</code>", HtmlText(driver.feature), Share(driver.index),
                 fmt::format("{} to {}", Share(driver.low), Share(driver.high)),
                 fmt::format("{:.2f}", driver.partial + 0.0), Bar(driver)});
    }
    html += table.Html("causes");
  }
  if (!any) html += "<p>Fewer than 30 completed flights, or nothing that varies: no cause can be told.</p>\n";
  for (const FailureDrivers& requirement : summary.failure_drivers) {
    if (requirement.drivers.empty()) continue;
    html += fmt::format("<h3>{} of {}: {} {}</h3>\n", requirement.nearest ? "Nearest to failing" : "Failing",
                        HtmlText(DescribeMetric(requirement.metric).title), requirement.flights,
                        requirement.flights == 1 ? "flight" : "flights");
    HtmlTable table(
        {{"Input"}, {"Feature"}, {"Among them"}, {"p", true}, {"False discoveries up to here", true}});
    for (const FailureDriver& driver : requirement.drivers) {
      table.Row({"<code>" + HtmlText(driver.input) + "</code>", HtmlText(driver.feature),
                 driver.larger ? "larger" : "smaller", ReadableText(driver.p),
                 Share(driver.false_discovery_rate)});
    }
    html += table.Html("causes");
  }
  return html;
}

}  // namespace dispersa
