#include "core/analysis/injection_summary.h"

#include <fmt/format.h>

#include <cmath>

#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

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

}  // namespace dispersa
