// What a campaign's page shows only while it flies.
#include "services/web/flying_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr std::size_t kMaxWorkers = 50;

/// Of equal values the one bin is as narrow as doubles are.
bool IsOfOneValue(const LiveHistogram& histogram) {
  return histogram.counts.size() == 1 && histogram.width < 1e-9 * std::max(1.0, std::fabs(histogram.low));
}

std::string HistogramFigure(const LiveHistogram& histogram, std::uint64_t cases) {
  const MetricInfo info = DescribeMetric(histogram.metric);
  if (IsOfOneValue(histogram))
    return fmt::format("<p>{}: {} in all {} completed flights.</p>\n", HtmlText(info.title),
                       HtmlText(WithUnit(histogram.low, info.unit)), histogram.n);
  std::vector<double> edges;
  for (std::size_t i = 0; i <= histogram.counts.size(); ++i)
    edges.push_back(histogram.low + static_cast<double>(i) * histogram.width);
  SvgChart bars({.label = info.title + (info.unit.empty() ? "" : ", " + info.unit)}, {.label = "cases"}, 520,
                250);
  bars.Bars(edges, histogram.counts, "");
  for (const double limit : histogram.limits) bars.VerticalLimit(limit, "limit " + StatedText(limit));
  const std::uint64_t n = histogram.n;
  const std::string without =
      cases > n ? fmt::format(" {} of {} cases are lost or do not define the metric.", cases - n, cases) : "";
  return Figure(bars.Svg("Histogram of " + info.title),
                fmt::format("{}: histogram of {} completed flights.{}", HtmlText(info.title), n, without));
}

std::string Histograms(const CampaignRow& row) {
  std::string figures;
  for (const LiveHistogram& histogram : row.histograms)
    if (histogram.n > 0) figures += HistogramFigure(histogram, row.done);
  if (figures.empty()) return "";
  return "<h2>Distribution of key metrics</h2>\n<div class=\"figures\" id=\"histograms\">\n" + figures +
         "</div>\n";
}

std::string Workers(const std::vector<WorkerRow>& workers) {
  const std::string head = "<h2>Workers of this coordinator</h2>\n";
  if (workers.empty()) return head + "<p>There is no worker: the campaign waits.</p>\n";
  HtmlTable table("Worker|Host|State|#Slots|#Cases flown");
  for (std::size_t i = 0; i < std::min(workers.size(), kMaxWorkers); ++i) {
    const WorkerRow& worker = workers[i];
    table.Row({Code(worker.id.substr(0, 8)), HtmlText(worker.host), worker.state,
               std::to_string(worker.slots), std::to_string(worker.flown)});
  }
  if (workers.size() > kMaxWorkers) table.Wide(fmt::format("and {} more", workers.size() - kMaxWorkers), "");
  return head + table.Html();
}

}  // namespace

std::string FlyingSection(const CampaignIndex& index, const CampaignRow& row) {
  return Histograms(row) + Workers(index.workers());
}

}  // namespace dispersa
