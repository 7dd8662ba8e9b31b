#include "core/pages/distribution_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"
#include "core/statistics/intervals.h"
#include "core/statistics/point_scatter.h"

namespace dispersa {
namespace {

struct Histogram {
  std::vector<double> edges;
  std::vector<double> counts;
};

/// Of values that are not all the same. Width of D. Freedman and P. Diaconis (Z. Wahrscheinlichkeitstheorie
/// 57 (1981) 453), but at least as many bins as H. A. Sturges (J. Am. Stat. Assoc. 21 (1926) 65) gives, and
/// at most 50.
Histogram MakeHistogram(const std::vector<double>& sorted) {
  const double low = sorted.front();
  const double range = sorted.back() - low;
  const double spread = Quantile(sorted, 0.75) - Quantile(sorted, 0.25);
  const double width = std::max(2.0 * spread / std::cbrt(static_cast<double>(sorted.size())), range / 50.0);
  const double least = std::ceil(std::log2(static_cast<double>(sorted.size()))) + 1.0;
  const int bins = static_cast<int>(std::max(std::ceil(range / width), least));
  Histogram histogram;
  for (int i = 0; i <= bins; ++i) histogram.edges.push_back(low + range * i / bins);
  histogram.counts.assign(static_cast<std::size_t>(bins), 0.0);
  for (const double value : sorted) {
    const int bin = std::min(bins - 1, static_cast<int>((value - low) / range * bins));
    histogram.counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  return histogram;
}

/// Confidence of 95 % about the share beyond a value, for each value taken alone; good cases from the best
/// on.
void AddConfidence(const std::vector<double>& good, std::size_t all, double lowest_share, SvgChart* chart) {
  constexpr double kConfidence = 0.95;
  constexpr double kSteps = 150.0;  // a logarithmic axis wants them evenly in decades
  const auto n = static_cast<std::int64_t>(all);
  std::vector<double> x, low, high;
  const auto ratio = std::pow(static_cast<double>(all), 1.0 / kSteps);
  for (std::int64_t beyond = n - 1;;
       beyond = std::min(beyond - 1, static_cast<std::int64_t>(static_cast<double>(beyond) / ratio))) {
    const auto worst = n - 1 - beyond;  // the rank of the value that so many cases lie beyond
    if (beyond < 0 || worst >= std::ssize(good)) break;
    const Interval share = ClopperPearson(beyond, n, kConfidence);
    x.push_back(good[static_cast<std::size_t>(worst)]);
    low.push_back(std::max(share.lower, lowest_share));
    high.push_back(share.upper);
  }
  chart->Band(x, low, high, "band-outer", "95 %");
}

std::string AxisLabel(const std::string& metric) {
  const MetricInfo info = DescribeMetric(metric);
  return info.title + (info.unit.empty() ? "" : ", " + info.unit);
}

/// The nominal flight's dot over those of the cases.
void AddCases(const std::string& x, const std::string& y, const CampaignSummary& summary,
              const CaseColumns& cases, SvgChart* chart) {
  chart->ShowsCases(x, y);
  chart->Points(CompletedValues(cases, x), CompletedValues(cases, y), "dots", "cases");
  if (!summary.nominal) return;
  chart->Points({summary.nominal->metrics[summary.metric_list.PositionOf(x)]},
                {summary.nominal->metrics[summary.metric_list.PositionOf(y)]}, "dot-nominal", "nominal");
}

constexpr std::size_t kFewestForEllipses = 10;

PointScatter PairsOf(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::vector<double>> pairs;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) pairs.push_back({x[i], y[i]});
  return PointScatterOf(pairs);
}

}  // namespace

namespace {

// A scatter of the completed cases with the ellipses of its covariance.
std::string ScatterFigure(const std::string& x, const std::string& y, const std::string& what,
                          const CampaignSummary& summary, const CaseColumns& cases) {
  SvgChart chart({.label = AxisLabel(x)}, {.label = AxisLabel(y)}, 520, 300);
  AddCases(x, y, summary, cases, &chart);
  std::string caption = what;
  const PointScatter scatter = PairsOf(CompletedValues(cases, x), CompletedValues(cases, y));
  if (scatter.n >= kFewestForEllipses) {
    std::string drawn;
    for (const double containment : {0.5, 0.95, 0.9973}) {
      // Two coordinates: the quantile of chi squared in closed form.
      const ScatterEllipse ellipse = EllipseOf(scatter.covariance, -2.0 * std::log1p(-containment));
      std::vector<double> outline_x, outline_y;
      for (const auto& point : OutlineOf(ellipse, {scatter.mean[0], scatter.mean[1]}, 120)) {
        outline_x.push_back(point[0]);
        outline_y.push_back(point[1]);
      }
      chart.Line(outline_x, outline_y, "ellipse", drawn.empty() ? "covariance ellipses" : "");
      drawn += (drawn.empty() ? "" : ", ") + PercentText(containment);
    }
    caption +=
        " The ellipses hold " + drawn + " of a normal law with the mean and covariance of these flights.";
  }
  return Figure(chart.Svg(caption), HtmlText(caption));
}

}  // namespace

std::string ImpactFigures(const CampaignSummary& summary, const CaseColumns& cases) {
  return ScatterFigure("impact_crossrange_km", "impact_downrange_km",
                       "Impact of each completed case, from the launch site along and across its azimuth.",
                       summary, cases) +
         ScatterFigure("impact_downrange_km", "apogee_altitude_km",
                       "Apogee and range of each completed case.", summary, cases);
}

std::string InjectionFigures(const CampaignSummary& summary, const CaseColumns& cases) {
  const std::string injection =
      ScatterFigure("injection_velocity_error_m_s", "injection_altitude_error_km",
                    "Injection of each completed case against the target.", summary, cases);
  SvgChart orbits({.label = AxisLabel("perigee_km")}, {.label = AxisLabel("apogee_km")}, 520, 300);
  AddCases("perigee_km", "apogee_km", summary, cases, &orbits);
  const std::string orbit_caption =
      "The orbits that follow from it; far from a normal law, so no ellipse is drawn.";
  return injection + Figure(orbits.Svg(orbit_caption), HtmlText(orbit_caption));
}

namespace {

std::string SameValue(const std::string& title, const std::vector<double>& good, const std::string& unit,
                      std::size_t flown, const std::vector<const RequirementSummary*>& requirements) {
  std::string limits;
  for (const RequirementSummary* requirement : requirements)
    limits += fmt::format(" The limit is {}.", HtmlText(LimitWords(*requirement, unit)));
  return fmt::format("<p>{}: {} in {} of {} flown cases.{}</p>\n", title,
                     HtmlText(WithUnit(good.front(), unit)), good.size(), flown, limits);
}

}  // namespace

std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary,
                                const CaseColumns& cases) {
  const MetricInfo info = DescribeMetric(metric);
  const std::string title = HtmlText(info.title);
  std::vector<double> good = SortedFinite(CompletedValues(cases, metric));
  if (good.empty()) return fmt::format("<p>{}: no completed flight defines it.</p>\n", title);

  std::vector<const RequirementSummary*> requirements;
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.metric == metric) requirements.push_back(&requirement);
  }
  // One value has no width: whatever a bar showed would be made up.
  if (good.front() == good.back()) return SameValue(title, good, info.unit, cases.rows(), requirements);
  const bool above = !requirements.empty() && !requirements.front()->below;
  const std::string axis = AxisLabel(metric);

  const Histogram histogram = MakeHistogram(good);
  SvgChart bars({.label = axis}, {.label = "cases"}, 520, 250);
  bars.ShowsCases(metric);
  bars.Bars(histogram.edges, histogram.counts, "");

  // A lost flight fails whatever it measured: it lies beyond all values, as in the verdict.
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
  tail.ShowsCases(metric);
  AddConfidence(good, cases.rows(), std::max(lowest_share, 1e-6), &tail);
  tail.Line(x, share, "line-0", "cases");
  for (const RequirementSummary* requirement : requirements) {
    bars.VerticalLimit(requirement->limit, "limit: " + LimitWords(*requirement, info.unit));
    if (requirement->low_limit) bars.VerticalLimit(*requirement->low_limit, "limit");
    tail.VerticalLimit(requirement->limit, "limit");
    if (!requirement->every_case)
      tail.HorizontalLimit(1.0 - requirement->probability,
                           fmt::format("{} allowed", PercentText(1.0 - requirement->probability)), "allowed");
    if (!requirement->bound) continue;
    bars.VerticalLimit(*requirement->bound, "bound", "bound");
    tail.VerticalLimit(*requirement->bound, "bound", "bound");
  }
  const std::size_t missing = cases.rows() - good.size();
  const std::string without =
      missing > 0 ? fmt::format(" {} of {} cases are lost or do not define it.", missing, cases.rows()) : "";
  return Figure(bars.Svg("Histogram of " + info.title),
                title + ": histogram of the completed flights." + without, "screen") +
         Figure(tail.Svg("Exceedance of " + info.title),
                title + ": share of the cases " + (above ? "at most" : "beyond") + " each value." + without);
}

}  // namespace dispersa
