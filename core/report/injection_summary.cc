#include "core/report/injection_summary.h"

#include <fmt/format.h>

#include <cmath>

#include "core/report/html_parts.h"
#include "core/report/metric_catalogue.h"
#include "core/report/text.h"

namespace dispersa {

std::optional<InjectionSummary> SummarizeInjection(const CaseColumns& cases) {
  std::array<std::vector<double>, 3> columns;
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = CompletedValues(cases, kInjectionMetrics[i]);
  std::vector<std::vector<double>> points;
  for (std::size_t row = 0; row < cases.rows(); ++row) {
    std::vector<double> point = {columns[0][row], columns[1][row], columns[2][row]};
    if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]))
      points.push_back(std::move(point));
  }
  if (points.size() < 2) return std::nullopt;
  InjectionSummary injection;
  injection.scatter = PointScatterOf(points);
  injection.containment = ContainmentOf(points, injection.scatter, {0.5, 0.9, 0.95, 0.99});
  return injection;
}

std::string InjectionSection(const InjectionSummary& injection) {
  const PointScatter& scatter = injection.scatter;
  std::string html = fmt::format(
      "<h3>Covariance of the injection</h3>\n<p>Of {} completed flights, in altitude, velocity and flight "
      "path angle together; "
      "<code>summary.json</code> has the covariance itself. An ellipsoid holds the stated share if the "
      "scatter is "
      "normal; what it really holds of these flights says whether it is.</p>\n",
      scatter.n);
  HtmlTable spread(
      {{""}, {"Mean", true}, {"Std", true}, {"Correlation with altitude", true}, {"with velocity", true}});
  for (std::size_t i = 0; i < kInjectionMetrics.size(); ++i) {
    const MetricInfo info = DescribeMetric(kInjectionMetrics[i]);
    std::vector<std::string> row = {HtmlText(info.title + ", " + info.unit), ReadableText(scatter.mean[i]),
                                    ReadableText(std::sqrt(scatter.covariance[i][i]))};
    for (std::size_t j = 0; j < 2; ++j) {
      const double variances = scatter.covariance[i][i] * scatter.covariance[j][j];
      row.push_back(
          j >= i || !(variances > 0.0) ? "" : FixedText(scatter.covariance[i][j] / std::sqrt(variances), 3));
    }
    spread.Row(row);
  }
  html += spread.Html("narrow");
  if (injection.containment.empty()) return html + "<p>Too few flights, or no spread, for ellipsoids.</p>\n";
  HtmlTable contained(
      {{"Stated", true}, {"Flights inside", true}, {"Share", true}, {"its 95 % limits", true}});
  for (const Containment& one : injection.containment) {
    contained.Row({PercentText(one.stated), fmt::format("{} of {}", one.inside, scatter.n),
                   PercentText(one.empirical),
                   PercentText(one.limits.lower) + " … " + PercentText(one.limits.upper)});
  }
  return html + contained.Html("narrow");
}

}  // namespace dispersa
