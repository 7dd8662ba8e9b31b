#include "core/results/metric_catalogue.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/input/unit_text.h"

namespace dispersa {

NameAndUnit SplitUnit(const std::string& name) {
  for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1))
    if (const std::string_view unit = UnitText(std::string_view(name).substr(at + 1)); !unit.empty())
      return {name.substr(0, at), std::string(unit)};
  return {name, ""};
}

namespace {

const Metric* Find(const std::string& name) {
  const auto metric = std::find_if(Metrics().begin(), Metrics().end(),
                                   [&](const Metric& candidate) { return candidate.name == name; });
  return metric == Metrics().end() ? nullptr : &*metric;
}

}  // namespace

Circle CircleOf(const std::string& metric) {
  if (const Metric* known = Find(metric)) return known->circle;
  if (metric.ends_with("longitude_deg")) return kCutAt180Deg;
  return metric.ends_with("azimuth_deg") || metric.ends_with("clock_deg") ? kCutAt0Deg : Circle{};
}

MetricInfo DescribeMetric(const std::string& name) {
  MetricInfo info;
  info.circle = CircleOf(name);
  if (const Metric* metric = Find(name)) {
    info.title = metric->title;
    info.symbol = metric->symbol;
    info.unit = metric->unit;
    info.group = TitleOf(metric->group);
    info.definition = metric->definition;
    info.over = metric->over;
    info.worse = metric->worse;
    info.is_part = metric->is_part;
    info.known = true;
    return info;
  }
  info.group = TitleOf(MetricGroup::kOwn);
  info.worse = Worse::kNeither;
  const NameAndUnit split = SplitUnit(name);
  info.title = split.stem;
  info.unit = split.unit;
  std::replace(info.title.begin(), info.title.end(), '_', ' ');
  if (!info.title.empty() && info.title[0] >= 'a')
    info.title[0] = static_cast<char>(info.title[0] - 'a' + 'A');
  return info;
}

double Badness(Worse worse, double value) {
  switch (worse) {
    case Worse::kLarger:
    case Worse::kNeither:
      return value;
    case Worse::kSmaller:
      return -value;
    case Worse::kFartherFromZero:
      return std::fabs(value);
  }
  return value;
}

const char* WorseName(Worse worse) {
  switch (worse) {
    case Worse::kLarger:
      return "larger";
    case Worse::kSmaller:
      return "smaller";
    case Worse::kFartherFromZero:
      return "farther_from_zero";
    case Worse::kNeither:
      return "neither";
  }
  return "";
}

}  // namespace dispersa
