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

/// Width of D. Freedman and P. Diaconis (Z. Wahrscheinlichkeitstheorie 57 (1981) 453), but at most 50 bins
/// and none narrower than `least_width`, so that it can be seen.
Histogram MakeHistogram(const std::vector<double>& sorted, double least_width) {
  const double low = sorted.front();
  const double range = sorted.back() - low;
  if (range <= 0.0) {
    const double half = low == 0.0 ? 0.5 : 0.05 * std::fabs(low);
    return {{low - half, low + half}, {static_cast<double>(sorted.size())}};
  }
  const double spread = Quantile(sorted, 0.75) - Quantile(sorted, 0.25);
  const double width =
      std::max({2.0 * spread / std::cbrt(static_cast<double>(sorted.size())), range / 50.0, least_width});
  const int bins = std::max(1, static_cast<int>(std::ceil(range / width)));
  Histogram histogram;
  for (int i = 0; i <= bins; ++i) histogram.edges.push_back(low + range * i / bins);
  histogram.counts.assign(static_cast<std::size_t>(bins), 0.0);
  for (const double value : sorted) {
    const int bin = std::min(bins - 1, static_cast<int>((value - low) / range * bins));
    histogram.counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  return histogram;
}

std::size_t Position(const std::string& metric) {
  const std::vector<std::string>& names = MetricNames();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), metric) - names.begin());
}

std::string AxisLabel(const std::string& metric) {
  const MetricInfo info = DescribeMetric(metric);
  return info.title + (info.unit.empty() ? "" : ", " + info.unit);
}

std::string Scatter(const std::string& x, const std::string& y, const CampaignSummary& summary,
                    const CaseColumns& cases, const std::string& caption) {
  SvgChart chart({.label = AxisLabel(x)}, {.label = AxisLabel(y)}, 520, 300);
  chart.Points(cases.metrics.at(Position(x)), cases.metrics.at(Position(y)), "dots", "cases");
  if (summary.nominal) {
    chart.Points({summary.nominal->metrics[Position(x)]}, {summary.nominal->metrics[Position(y)]},
                 "dot-nominal", "nominal");
  }
  return Figure(chart.Svg(caption), HtmlText(caption));
}

}  // namespace

std::string InjectionFigures(const CampaignSummary& summary, const CaseColumns& cases) {
  return Scatter("injection_velocity_error_m_s", "injection_altitude_error_km", summary, cases,
                 "Injection of each completed case against the target.") +
         Scatter("perigee_km", "apogee_km", summary, cases, "The orbits that follow from it.");
}

std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary,
                                const CaseColumns& cases) {
  const MetricInfo info = DescribeMetric(metric);
  const std::string title = HtmlText(info.title);
  const std::size_t position = Position(metric);
  const std::vector<double> sorted = SortedFinite(cases.metrics.at(position));
  if (sorted.empty()) return fmt::format("<p>{}: no case defines it.</p>\n", title);

  std::vector<const RequirementSummary*> requirements;
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.metric == metric) requirements.push_back(&requirement);
  }
  const bool above = !requirements.empty() && !requirements.front()->below;
  const std::string axis = AxisLabel(metric);

  double low = sorted.front();
  double high = sorted.back();
  for (const RequirementSummary* requirement : requirements) {
    low = std::min(low, requirement->limit);
    high = std::max(high, requirement->limit);
  }
  const Histogram histogram = MakeHistogram(sorted, (high - low) / 60.0);
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
    share.insert(share.end(),
                 {(all - static_cast<double>(i)) / all, (all - static_cast<double>(i) - 1.0) / all});
  }
  double lowest_share = 0.5 / all;
  for (const RequirementSummary* requirement : requirements) {
    lowest_share = std::min(lowest_share, 0.5 * (1.0 - requirement->probability));
  }
  SvgChart tail({.label = axis},
                {.label = above ? "share of cases at most this" : "share of cases beyond this",
                 .low = std::max(lowest_share, 1e-6),
                 .high = 1.0,
                 .logarithmic = true,
                 .percent = true},
                520, 250);
  tail.Line(x, share, "line-0", "cases");
  for (const RequirementSummary* requirement : requirements) {
    bars.VerticalLimit(requirement->limit, "limit: " + LimitWords(*requirement, info.unit));
    tail.VerticalLimit(requirement->limit, "limit");
    tail.HorizontalLimit(1.0 - requirement->probability,
                         fmt::format("{} allowed", PercentText(1.0 - requirement->probability)));
  }
  const std::size_t undefined = cases.rows() - sorted.size();
  const std::string missing =
      undefined > 0 ? fmt::format(" {} of {} cases do not define it.", undefined, cases.rows()) : "";
  return Figure(bars.Svg("Histogram of " + info.title), title + ": histogram of the cases." + missing) +
         Figure(
             tail.Svg("Exceedance of " + info.title),
             title + ": share of the cases " + (above ? "at most" : "beyond") + " each value." +
                 (requirements.empty() ? ""
                                       : " The curve should fall below the allowed share before the limit."));
}

}  // namespace dispersa
