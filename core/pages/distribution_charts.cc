#include "core/pages/distribution_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/environment/earth.h"
#include "core/flight/orbit.h"
#include "core/math/functions.h"
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
  // The page holds no values of the others: they would make it too large to send.
  if (x != "semi_major_axis_error_km") chart->ShowsCases(x, y);
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

void AddLimits(const std::string& metric, bool horizontal, const CampaignSummary& summary, SvgChart* chart) {
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.metric != metric) continue;
    const std::string unit = DescribeMetric(metric).unit;
    const auto add = [&](double value, const std::string& legend) {
      horizontal ? chart->HorizontalLimit(value, legend) : chart->VerticalLimit(value, legend);
    };
    add(requirement.limit, LimitWords(requirement, unit));
    if (requirement.low_limit) add(*requirement.low_limit, "");
  }
}

struct Aim {
  double x = 0.0, y = 0.0;
  const char* legend = "target";
};

/// Apsides of the reference's orbit. Its file states speed, angle and geodetic altitude; the radius follows
/// from the nominal flight, whose semi-major axis and its error are measured.
std::optional<Aim> ReferenceApsides(const CampaignSummary& summary) {
  if (!summary.nominal || summary.nominal->outcome != Outcome::kCompleted) return std::nullopt;
  const auto nominal_m = [&](const char* metric) {
    return 1e3 * summary.nominal->metrics[summary.metric_list.PositionOf(metric)];
  };
  const Earth earth = Wgs84();
  const Orbit& orbit = summary.reference_orbit;
  const double axis_m = earth.equatorial_radius_m + 0.5 * (nominal_m("apogee_km") + nominal_m("perigee_km")) -
                        nominal_m("semi_major_axis_error_km");
  const double radius_m = 2.0 / (Square(orbit.velocity_m_s) / earth.mu_m3_s2 + 1.0 / axis_m);
  const SinCos path = SineCosine(orbit.flight_path_angle_rad);
  const OrbitElements elements =
      ElementsOf(earth, {radius_m, 0.0, 0.0}, Vector3(path.sin, path.cos, 0.0) * orbit.velocity_m_s);
  return Aim{elements.perigee_altitude_m * 1e-3, elements.apogee_altitude_m * 1e-3, "reference"};
}

/// The completed cases with the ellipses of their covariance. Empty if no case has both values.
std::string ScatterFigure(const std::string& x, const std::string& y, const std::string& what,
                          const std::optional<Aim>& aim, const CampaignSummary& summary,
                          const CaseColumns& cases) {
  const PointScatter scatter = PairsOf(CompletedValues(cases, x), CompletedValues(cases, y));
  if (scatter.n == 0) return "";
  SvgChart chart({.label = AxisLabel(x)}, {.label = AxisLabel(y)}, 520, 300);
  AddCases(x, y, summary, cases, &chart);
  if (aim && std::isfinite(aim->x) && std::isfinite(aim->y))
    chart.Points({aim->x}, {aim->y}, "dot-target", aim->legend);
  AddLimits(x, false, summary, &chart);
  AddLimits(y, true, summary, &chart);
  std::string caption = what;
  const bool has_spread =
      scatter.n >= kFewestForEllipses && scatter.covariance[0][0] > 0.0 && scatter.covariance[1][1] > 0.0;
  if (has_spread) {
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
                       {}, summary, cases) +
         ScatterFigure("impact_downrange_km", "apogee_altitude_km",
                       "Apogee and range of each completed case.", {}, summary, cases);
}

std::string InjectionFigures(const CampaignSummary& summary, const CaseColumns& cases) {
  return ScatterFigure("injection_velocity_error_m_s", "injection_altitude_error_km",
                       "Injection of each completed case against the target.", Aim{}, summary, cases) +
         ScatterFigure(
             "perigee_km", "apogee_km",
             "The orbits that follow from it. Near a circle they crowd on its line, far from a normal law.",
             ReferenceApsides(summary), summary, cases) +
         ScatterFigure("semi_major_axis_error_km", "inclination_error_deg",
                       "Size and plane of the orbit of each completed case against the target.", Aim{},
                       summary, cases);
}

namespace {

/// A limit of a requirement, drawn where the values are.
struct Limit {
  const RequirementSummary& of;
  double value = 0.0;
  bool above = false;                ///< values shall lie above it
  bool is_first = true;              ///< of its requirement
  std::optional<double> bound = {};  ///< of its side
};

std::vector<Limit> LimitsBeside(double middle, const Circle& circle,
                                const std::vector<const RequirementSummary*>& requirements) {
  std::vector<Limit> limits;
  for (const RequirementSummary* each : requirements) {
    const auto add = [&](double value, bool above) {
      const bool is_first = limits.empty() || &limits.back().of != each;
      limits.push_back({*each, NearTo(middle, value, circle), above, is_first});
      if (each->bound && LimitBeside(*each, *each->bound) == value)
        limits.back().bound = NearTo(middle, *each->bound, circle);
    };
    add(each->limit, !each->below);
    if (each->low_limit) add(*each->low_limit, true);
  }
  return limits;
}

std::string SameValue(const std::string& title, const std::vector<double>& good, const std::string& unit,
                      std::size_t flown, const std::vector<const RequirementSummary*>& requirements) {
  std::string limits;
  for (const RequirementSummary* requirement : requirements)
    limits += fmt::format(" The limit is {}.", HtmlText(LimitWords(*requirement, unit)));
  return fmt::format("<p>{}: {} in {} of {} flown cases.{}</p>\n", title,
                     HtmlText(WithUnit(good.front(), unit)), good.size(), flown, limits);
}

/// Of one side: the share of the cases beyond each value, or at most each value.
class TailChart {
 public:
  TailChart(const std::string& metric, bool above, std::size_t cases,
            const std::vector<const RequirementSummary*>& requirements)
      : above_(above),
        lowest_share_(LowestShare(cases, requirements)),
        chart_({.label = AxisLabel(metric)},
               {.label = above ? "share of cases at most this" : "share of cases beyond this",
                .low = lowest_share_,
                .high = 1.0,
                .logarithmic = true,
                .percent = true},
               520, 250) {
    chart_.ShowsCases(metric);
  }

  /// A lost flight fails whatever it measured: it lies beyond all values, as in the verdict.
  void AddCases(std::vector<double> sorted, std::size_t cases) {
    if (above_) std::reverse(sorted.begin(), sorted.end());
    const auto all = static_cast<double>(cases);
    std::vector<double> x, share;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      x.insert(x.end(), {sorted[i], sorted[i]});
      share.insert(share.end(),
                   {(all - static_cast<double>(i)) / all, (all - static_cast<double>(i) - 1.0) / all});
    }
    AddConfidence(sorted, cases, lowest_share_, &chart_);
    chart_.Line(x, share, "line-0", "cases");
  }
  void AddLimit(const Limit& limit) {
    chart_.VerticalLimit(limit.value, "limit");
    if (!limit.of.every_case)
      chart_.HorizontalLimit(1.0 - limit.of.probability,
                             fmt::format("{} allowed", PercentText(1.0 - limit.of.probability)), "allowed");
    if (limit.bound) chart_.VerticalLimit(*limit.bound, "bound", "bound");
  }
  std::string Html(const MetricInfo& info, const std::string& without, bool has_two_sides) const {
    return Figure(chart_.Svg("Exceedance of " + info.title),
                  HtmlText(info.title) + ": share of the cases " + (above_ ? "at most" : "beyond") +
                      " each value." +
                      (has_two_sides ? " A range allows its share on both sides together." : "") + without);
  }

 private:
  static double LowestShare(std::size_t cases, const std::vector<const RequirementSummary*>& requirements) {
    double share = 0.5 / static_cast<double>(cases);
    for (const RequirementSummary* requirement : requirements)
      share = std::min(share, 0.5 * (1.0 - requirement->probability));
    return std::max(share, 1e-6);
  }

  bool above_;
  double lowest_share_;
  SvgChart chart_;
};

}  // namespace

std::string DistributionFigures(const std::string& metric, const CampaignSummary& summary,
                                const CaseColumns& cases) {
  const MetricInfo info = DescribeMetric(metric);
  const std::string title = HtmlText(info.title);
  const std::vector<double> good = SortedFinite(CompletedValues(cases, metric));
  if (good.empty()) return fmt::format("<p>{}: no completed flight defines it.</p>\n", title);

  std::vector<const RequirementSummary*> requirements;
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.metric == metric) requirements.push_back(&requirement);
  }
  // One value has no width: whatever a bar showed would be made up.
  if (good.front() == good.back()) return SameValue(title, good, info.unit, cases.rows(), requirements);

  const Histogram histogram = MakeHistogram(good);
  SvgChart bars({.label = AxisLabel(metric)}, {.label = "cases"}, 520, 250);
  bars.ShowsCases(metric);
  bars.Bars(histogram.edges, histogram.counts, "");
  const std::vector<Limit> limits = LimitsBeside(Quantile(good, 0.5), info.circle, requirements);
  for (const Limit& limit : limits) {
    bars.VerticalLimit(limit.value, limit.is_first ? "limit: " + LimitWords(limit.of, info.unit) : "limit");
    if (limit.bound) bars.VerticalLimit(*limit.bound, "bound", "bound");
  }
  const std::size_t missing = cases.rows() - good.size();
  const std::string without =
      missing > 0 ? fmt::format(" {} of {} cases are lost or do not define it.", missing, cases.rows()) : "";
  std::string html = Figure(bars.Svg("Histogram of " + info.title),
                            title + ": histogram of the completed flights." + without, "screen");
  // A chart for each side that has a limit.
  const auto has_side = [&](bool above) {
    return std::any_of(limits.begin(), limits.end(), [&](const Limit& one) { return one.above == above; });
  };
  for (const bool above : {false, true}) {
    if (!has_side(above) && (above || has_side(true))) continue;
    TailChart tail(metric, above, cases.rows(), requirements);
    tail.AddCases(good, cases.rows());
    for (const Limit& limit : limits)
      if (limit.above == above) tail.AddLimit(limit);
    html += tail.Html(info, without, has_side(false) && has_side(true));
  }
  return html;
}

}  // namespace dispersa
