#include <fmt/format.h>

#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

namespace dispersa {

std::string InjectionSection(const InjectionSummary& injection) {
  const PointScatter& scatter = injection.scatter;
  std::string html = fmt::format(
      "<h3>Covariance of the injection</h3>\n"
      "<p>Joint scatter of {} completed flights in altitude, velocity and flight path angle. "
      "<code>summary.json</code> has the covariance. If the scatter is normal, an ellipsoid contains the "
      "stated share. The share of these flights inside shows whether it is normal.</p>\n",
      scatter.n);
  HtmlTable spread("!|#Mean|#Std|#Correlation with altitude|#with velocity");
  for (std::size_t i = 0; i < kInjectionMetrics.size(); ++i) {
    const MetricInfo info = DescribeMetric(kInjectionMetrics[i]);
    const double deviation = std::sqrt(scatter.covariance[i][i]);
    std::vector<std::string> row = {HtmlText(info.title + ", " + info.unit),
                                    ScatterText(scatter.mean[i], deviation), RoundedText(deviation)};
    for (std::size_t j = 0; j < 2; ++j) {
      const double variances = scatter.covariance[i][i] * scatter.covariance[j][j];
      row.push_back(
          j >= i || !(variances > 0.0) ? "" : FixedText(scatter.covariance[i][j] / std::sqrt(variances), 3));
    }
    spread.Row(row);
  }
  html += spread.Html("narrow");
  if (injection.containment.empty()) return html + "<p>Too few flights, or no spread, for ellipsoids.</p>\n";
  HtmlTable contained("!#Stated|#Flights inside|#Share|#its 95 % limits");
  for (const Containment& one : injection.containment) {
    contained.Row(
        {PercentText(one.stated), fmt::format("{} of {}", one.inside, scatter.n), ShareText(one.empirical),
         ShareText(one.limits.lower, Rounding::kDown) + " … " + ShareText(one.limits.upper, Rounding::kUp)});
  }
  return html + contained.Html("narrow");
}

}  // namespace dispersa
