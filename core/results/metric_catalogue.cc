#include "core/results/metric_catalogue.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace dispersa {
namespace {

struct UnitSuffix {
  std::string_view suffix;
  std::string_view unit;
};

/// A longer suffix comes before the shorter ones that it ends in.
constexpr UnitSuffix kUnits[] = {
    {"_deg_s2", "°/s²"}, {"_pa_rad", "Pa rad"}, {"_deg_s", "°/s"}, {"_rad_s", "rad/s"}, {"_kg_m2", "kg m²"},
    {"_n_m", "N m"},     {"_kg_s", "kg/s"},     {"_km_s", "km/s"}, {"_m_s", "m/s"},     {"_deg", "°"},
    {"_rad", "rad"},     {"_kpa", "kPa"},       {"_pa", "Pa"},     {"_km", "km"},       {"_kg", "kg"},
    {"_ms", "ms"},       {"_db", "dB"},         {"_n", "N"},       {"_m", "m"},         {"_g", "g"},
    {"_s", "s"},
};

}  // namespace

NameAndUnit SplitUnit(const std::string& name) {
  for (const UnitSuffix& unit : kUnits) {
    if (name.ends_with(unit.suffix))
      return {name.substr(0, name.size() - unit.suffix.size()), std::string(unit.unit)};
  }
  return {name, ""};
}

MetricInfo DescribeMetric(const std::string& name) {
  MetricInfo info;
  const auto metric = std::find_if(Metrics().begin(), Metrics().end(),
                                   [&](const Metric& candidate) { return candidate.name == name; });
  if (metric != Metrics().end()) {
    info.title = metric->title;
    info.symbol = metric->symbol;
    info.unit = metric->unit;
    info.group = TitleOf(metric->group);
    info.definition = metric->definition;
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
