#include "core/flight/metric_list.h"

#include <algorithm>
#include <utility>

#include "core/flight/metrics.h"
#include "core/math/assertion.h"

namespace dispersa {

MetricList::MetricList(std::size_t stages, std::vector<std::string> own)
    : stages_(stages), of_vehicle_(MetricCount(stages)), own_(std::move(own)) {}

const std::string& MetricList::NameAt(std::size_t position) const {
  return position < of_vehicle_ ? MetricNames()[position] : own_[position - of_vehicle_];
}

std::optional<std::size_t> MetricList::Find(const std::string& name) const {
  const auto end = MetricNames().begin() + static_cast<std::ptrdiff_t>(of_vehicle_);
  if (const auto found = std::find(MetricNames().begin(), end, name); found != end)
    return static_cast<std::size_t>(found - MetricNames().begin());
  const auto found = std::find(own_.begin(), own_.end(), name);
  if (found == own_.end()) return std::nullopt;
  return of_vehicle_ + static_cast<std::size_t>(found - own_.begin());
}

std::size_t MetricList::PositionOf(const std::string& name) const {
  const std::optional<std::size_t> found = Find(name);
  DISPERSA_ASSERT(found);
  return *found;
}

std::vector<std::string> NamesOf(const MetricList& metrics) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < metrics.size(); ++i) names.push_back(metrics.NameAt(i));
  return names;
}

}  // namespace dispersa
