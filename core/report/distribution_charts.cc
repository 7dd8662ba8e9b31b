#include "core/report/distribution_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/report/html_parts.h"
#include "core/report/metric_catalogue.h"
#include "core/report/svg_chart.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

struct Histogram {
  std::vector<double> edges;
  std::vector<double> counts;
};

/// Width of D. Freedman and P. Diaconis (Z. Wahrscheinlichkeitstheorie 57 (1981) 453), between 8 and 50 bins.
Histogram MakeHistogram(const std::vector<double>& sorted) {
  const double low = sorted.front();
  const double range = sorted.back() - low;
  if (range <= 0.0) {
    const double half = low == 0.0 ? 0.5 : 0.05 * std::fabs(low);
    return {{low - half, low + half}, {static_cast<double>(sorted.size())}};
  }
  const double spread = Quantile(sorted, 0.75) - Quantile(sorted, 0.25);
  const double width = 2.0 * spread / std::cbrt(static_cast<double>(sorted.size()));
  const int bins = static_cast<int>(std::clamp(width > 0.0 ? std::ceil(range / width) : 50.0, 8.0, 50.0));
  Histogram histogram;
  for (int i = 0; i <= bins; ++i) histogram.edges.push_back(low + range * i / bins);
  histogram.counts.assign(static_cast<std::size_t>(bins), 0.0);
  for (const double value : sorted) {
    const int bin = std::min(bins - 1, static_cast<int>((value - low) / range * bins));
    histogram.counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  return histogram;
}

std::string LimitText(const RequirementSummary& requirement, const std::string& unit) {
  return fmt::format("{} {}{}{}", requirement.below ? "below" : "above", ReadableText(requirement.limit),
                     unit.empty() ? "" : " ", unit);
}

}  // namespace

std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary, const CaseColumns& cases) {
  const MetricInfo info = DescribeMetric(metric);
  const std::string title = HtmlText(info.title);
  const std::vector<std::string>& names = MetricNames();
  const auto position = static_cast<std::size_t>(std::find(names.begin(), names.end(), metric) - names.begin());
  const std::vector<double> sorted = SortedFinite(cases.metrics.at(position));
  if (sorted.empty()) return fmt::format("<p>{}: no case defines it.</p>\n", title);

  std::vector<const RequirementSummary*> requirements;
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.metric == metric) requirements.push_back(&requirement);
  }
  const bool above = !requirements.empty() && !requirements.front()->below;
  const std::string axis = info.title + (info.unit.empty() ? "" : ", " + info.unit);

  const Histogram histogram = MakeHistogram(sorted);
  SvgChart bars({.label = axis}, {.label = "cases"}, 520, 250);
  bars.Bars(histogram.edges, histogram.counts, "");

  // A lost flight fails whatever it measured: it lies beyond all values, as in the verdict.
  std::vector<double> good = cases.metrics[position];
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted) good[i] = kUndefined;
  }
  good = SortedFinite(std::move(good));
  if (above) std::reverse(good.begin(), good.end());
  const auto all = static_cast<double>(cases.rows());
  std::vector<double> x;
  std::vector<double> share;
  for (std::size_t i = 0; i < good.size(); ++i) {
    x.insert(x.end(), {good[i], good[i]});
    share.insert(share.end(), {(all - static_cast<double>(i)) / all, (all - static_cast<double>(i) - 1.0) / all});
  }
  SvgChart tail({.label = axis}, {.label = above ? "share of cases at most this" : "share of cases beyond this",
                                  .low = 0.5 / all, .high = 1.0, .logarithmic = true, .percent = true}, 520, 250);
  tail.Line(x, share, "line-0", "cases");
  for (const RequirementSummary* requirement : requirements) {
    bars.VerticalLimit(requirement->limit, "limit: " + LimitText(*requirement, info.unit));
    tail.VerticalLimit(requirement->limit, "limit");
    if (1.0 - requirement->probability >= 0.5 / all) {
      tail.HorizontalLimit(1.0 - requirement->probability, fmt::format("{} allowed", PercentText(1.0 - requirement->probability)));
    }
  }
  const std::size_t undefined = cases.rows() - sorted.size();
  const std::string missing = undefined > 0 ? fmt::format(" {} of {} cases do not define it.", undefined, cases.rows()) : "";
  return Figure(bars.Svg("Histogram of " + info.title), title + ": histogram of the cases." + missing) +
         Figure(tail.Svg("Exceedance of " + info.title),
                title + ": share of the cases " + (above ? "at most" : "beyond") + " each value." +
                    (requirements.empty() ? "" : " The curve should fall below the allowed share before the limit."));
}

}  // namespace dispersa
