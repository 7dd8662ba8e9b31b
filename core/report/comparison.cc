#include "core/report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/report/html_parts.h"
#include "core/report/metric_catalogue.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

struct Pairs {
  std::vector<std::size_t> a, b;  ///< rows
};

/// By case index, then column by column: a pair stays where every input that was read of both is equal.
Pairs PairUp(const CaseColumns& a, const CaseColumns& b) {
  Pairs pairs;
  for (std::size_t row = 0, other = 0; row < a.rows(); ++row) {
    while (other < b.rows() && b.index[other] < a.index[row]) ++other;
    if (other == b.rows() || b.index[other] != a.index[row]) continue;
    pairs.a.push_back(row);
    pairs.b.push_back(other);
  }
  std::vector<bool> same(pairs.a.size(), true);
  for (std::size_t i = 0; i < std::min(a.inputs.size(), b.inputs.size()); ++i) {
    if (a.inputs[i].empty() || b.inputs[i].empty()) continue;  // not read
    const std::vector<double> of_a = a.inputs[i];
    const std::vector<double> of_b = b.inputs[i];
    for (std::size_t pair = 0; pair < same.size(); ++pair)
      if (of_a[pairs.a[pair]] != of_b[pairs.b[pair]]) same[pair] = false;
  }
  Pairs kept;
  for (std::size_t pair = 0; pair < same.size(); ++pair) {
    if (!same[pair]) continue;
    kept.a.push_back(pairs.a[pair]);
    kept.b.push_back(pairs.b[pair]);
  }
  return kept;
}

std::string BoundText(double value) {
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  return ReadableText(value);
}

std::string IntervalText(const Interval& interval) {
  return BoundText(interval.lower) + " … " + BoundText(interval.upper);
}

}  // namespace

const std::vector<std::string>& ComparedMetrics() {
  static const std::vector<std::string> names = {
      "pitch_error_rms_deg", "pitch_error_peak_deg", "yaw_error_rms_deg",          "yaw_error_peak_deg",
      "roll_error_peak_deg", "deflection_peak_deg",  "deflection_limit_cycle_deg", "deflection_travel_deg"};
  return names;
}

Comparison Compare(const CaseColumns& a, const CaseColumns& b, const std::vector<std::string>& metrics) {
  const Pairs pairs = PairUp(a, b);
  Comparison comparison;
  comparison.pairs = pairs.a.size();
  comparison.unpaired = a.rows() + b.rows() - 2 * pairs.a.size();
  for (const std::string& metric : metrics) {
    const std::vector<double> all_a = CompletedValues(a, metric);
    const std::vector<double> all_b = CompletedValues(b, metric);
    std::vector<double> values_a, values_b;
    MetricComparison result;
    result.metric = metric;
    for (std::size_t i = 0; i < pairs.a.size(); ++i) {
      values_a.push_back(all_a[pairs.a[i]]);
      values_b.push_back(all_b[pairs.b[i]]);
      const double gain = std::isnan(values_a[i]) ? HUGE_VAL : values_a[i] - values_b[i];
      if (!std::isnan(values_b[i]) && gain > 0.0)
        result.better.push_back({a.index[pairs.a[i]], values_a[i], values_b[i]});
    }
    const auto gain = [](const MetricComparison::BetterCase& c) {
      return std::isnan(c.a) ? HUGE_VAL : c.a - c.b;
    };
    std::stable_sort(result.better.begin(), result.better.end(),
                     [&](const auto& one, const auto& other) { return gain(one) > gain(other); });
    result.difference = ComparePaired(values_a, values_b, kComparisonConfidence);
    comparison.metrics.push_back(std::move(result));
  }
  return comparison;
}

std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b) {
  const std::string a = HtmlText(name_a);
  const std::string b = HtmlText(name_b);
  HtmlTable table({{"Metric"},
                   {"median of the difference", true},
                   {"95 % interval", true},
                   {"median of the ratio", true},
                   {"95 % interval", true},
                   {a + " better", true},
                   {b + " better", true},
                   {"sign test, p", true}});
  for (const MetricComparison& metric : comparison.metrics) {
    const PairedDifference& d = metric.difference;
    const MetricInfo info = DescribeMetric(metric.metric);
    table.Row({HtmlText(info.title + (info.unit.empty() ? "" : ",\u00a0" + info.unit)),
               BoundText(d.median_difference), IntervalText(d.difference_interval), BoundText(d.median_ratio),
               IntervalText(d.ratio_interval), fmt::format("{}", d.worse), fmt::format("{}", d.better),
               ReadableText(d.sign_test_p)});
  }
  return table.Html() +
         fmt::format("<p class=\"soft\">Differences are {} less {}, ratios {} over {}; {} pairs.</p>\n", b, a,
                     b, a, comparison.pairs);
}

std::string BetterCasesList(const MetricComparison& metric, const std::string& name_a,
                            const std::string& name_b) {
  const MetricInfo info = DescribeMetric(metric.metric);
  const std::string intro = fmt::format("cases in which {} is better than {} in {}: {}", HtmlText(name_b),
                                        HtmlText(name_a), HtmlText(info.title), metric.better.size());
  if (metric.better.empty()) return "<p class=\"soft\">" + intro + "</p>\n";
  std::string list;
  for (const MetricComparison::BetterCase& c : metric.better) {
    list += fmt::format("{}{} ({} against {})", list.empty() ? "" : ", ", c.case_index,
                        std::isnan(c.b) ? "lost" : ReadableText(c.b),
                        std::isnan(c.a) ? "lost" : ReadableText(c.a));
  }
  return "<details><summary>" + intro + "</summary><p class=\"soft\">" + list + "</p></details>\n";
}

}  // namespace dispersa
