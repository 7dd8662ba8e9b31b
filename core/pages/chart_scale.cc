#include "core/pages/chart_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/results/text.h"

namespace dispersa {
namespace {

/// A step of 1, 2 or 5 times a power of ten, about `range / count`.
double RoundStep(double range, int count) {
  const double raw = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  return power * (ratio < 1.5 ? 1.0 : ratio < 3.5 ? 2.0 : ratio < 7.5 ? 5.0 : 10.0);
}

}  // namespace

ChartScale::ChartScale(const ChartAxis& axis, double low, double high, double from, double to,
                       int about_ticks)
    : logarithmic_(axis.logarithmic), low_(low), high_(high), from_(from), to_(to) {
  if (!(low_ <= high_)) low_ = 0.0, high_ = 1.0;  // no data
  if (axis.low) low_ = *axis.low;
  if (axis.high) high_ = *axis.high;
  if (!(low_ < high_)) {
    const double room = low_ == 0.0 ? 1.0 : 0.1 * std::fabs(low_);
    low_ -= room;
    high_ += room;
  }
  if (logarithmic_) {
    LogarithmicTicks(axis, about_ticks);
  } else {
    LinearTicks(axis, about_ticks);
  }
}

double ChartScale::At(double value) const {
  const double part =
      logarithmic_ ? std::log10(value / low_) / std::log10(high_ / low_) : (value - low_) / (high_ - low_);
  return from_ + (to_ - from_) * std::clamp(part, 0.0, 1.0);
}

void ChartScale::LinearTicks(const ChartAxis& axis, int about_ticks) {
  const double step = RoundStep(high_ - low_, about_ticks);
  if (!axis.low) low_ = step * std::floor(low_ / step + 1e-9);
  if (!axis.high) high_ = step * std::ceil(high_ / step - 1e-9);
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ + 1e-9 * step; k += 1.0) {
    const double value = k * step + 0.0;
    ticks_.push_back({value, axis.percent ? PercentText(value) : fmt::format("{:.{}f}", value, decimals)});
  }
}

void ChartScale::LogarithmicTicks(const ChartAxis& axis, int about_ticks) {
  // Every decade, unless the labels would overlap. Of few decades 2 and 5 too.
  const double decades = std::log10(high_ / low_);
  const double stride = decades > 2.0 * about_ticks ? std::ceil(decades / about_ticks) : 1.0;
  for (double k = stride * std::floor(std::log10(low_) / stride); std::pow(10.0, k) <= high_ * (1.0 + 1e-9);
       k += stride)
    for (const double times : {1.0, 2.0, 5.0}) {
      const double value = times * std::pow(10.0, k);
      if (times > 1.0 && decades > 2.0) break;
      if (value < low_ * (1.0 - 1e-9) || value > high_ * (1.0 + 1e-9)) continue;
      ticks_.push_back({value, axis.percent ? PercentText(value) : fmt::format("{:g}", value)});
    }
}

}  // namespace dispersa
