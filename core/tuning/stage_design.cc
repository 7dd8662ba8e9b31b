#include "core/tuning/stage_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/control/autopilot.h"
#include "core/control/fuzzy.h"
#include "core/control/lyapunov.h"

namespace dispersa {

namespace {

bool Learns(const AxisConfig& axis) { return InfoOf(axis.law).adaptation || InfoOf(axis.law).integral; }
bool IsAugmented(const AxisConfig& axis) { return InfoOf(axis.law).augmentation; }

}  // namespace

double RoundToDigits(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}

bool Learns(const AutopilotConfig& autopilot) {
  return Learns(autopilot.pitch) || Learns(autopilot.yaw) || Learns(autopilot.roll);
}

void ApplyDesign(const StageDesign& design, int stage, AutopilotConfig& autopilot) {
  const double w = design.bandwidth_rad_s;
  const AxisGains gains = {RoundToDigits(w * w, kDesignDigits),
                           RoundToDigits(2.0 * design.damping * w, kDesignDigits)};
  const std::size_t at = static_cast<std::size_t>(stage);
  for (AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll}) {
    axis->gains[at] = gains;
    const double integral_1_s3 = design.learning * w * w * w;
    if (InfoOf(axis->law).integral) axis->integral.ki_1_s3[at] = RoundToDigits(integral_1_s3, kDesignDigits);
    if (!InfoOf(axis->law).adaptation) continue;
    const double p12 = SolveLyapunov(gains, axis->adaptation.q)(0, 1);
    axis->adaptation.gamma[at] = RoundToDigits(integral_1_s3 * kFuzzyRules / p12, kDesignDigits);
  }
  const StageFilters& f = design.filters;
  if (f.low_pass_rad_s == 0.0) return;
  const auto round = [](double value) { return RoundToDigits(value, kDesignDigits); };
  for (AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw}) {
    std::erase_if(axis->filters, [&](const FilterSection& section) { return section.stage == stage + 1; });
    axis->filters.push_back({0.0, 0.0, round(f.low_pass_rad_s), round(f.low_pass_damping), stage + 1});
    const double notch = round(f.notch_rad_s);
    axis->filters.push_back(
        {notch, round(f.notch_zeros_damping), notch, round(f.notch_poles_damping), stage + 1});
  }
  const std::vector<std::size_t> blend = BlendedGyros(autopilot, stage);
  if (blend.empty()) return;
  autopilot.rate_gyros[blend[0]].weight = round(f.first_gyro_weight);
  autopilot.rate_gyros[blend[1]].weight = 1.0 - autopilot.rate_gyros[blend[0]].weight;
}

std::vector<double> ScheduledTimes(const AutopilotConfig& autopilot, int stage) {
  std::vector<double> times = {0.0};
  for (const ScheduleEntry& entry : autopilot.pitch.schedule)
    if (entry.stage == stage + 1) times.push_back(entry.at_s);
  return times;
}

void ApplyDesign(const std::vector<StageDesign>& designs, int stage, AutopilotConfig& autopilot) {
  const std::vector<double> times = ScheduledTimes(autopilot, stage);
  // The design is applied to a stage's own gains and filters first. The entry of the schedule then holds
  // these.
  std::vector<std::vector<ScheduleEntry>> entries(kAxes);
  const auto axes_of = [](AutopilotConfig& config) {
    return std::array<AxisConfig*, kAxes>{&config.pitch, &config.yaw, &config.roll};
  };
  for (std::size_t k = 1; k < designs.size(); ++k) {
    AutopilotConfig then = autopilot;
    ApplyDesign(designs[k], stage, then);
    const auto axes = axes_of(then);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::size_t at = static_cast<std::size_t>(stage);
      const bool integrates = InfoOf(axes[i]->law).integral;
      ScheduleEntry entry{
          stage + 1, times[k], axes[i]->gains[at], integrates ? axes[i]->integral.ki_1_s3[at] : 0.0, {}};
      for (const std::size_t filter : FiltersOfStage(*axes[i], stage + 1))
        entry.filters.push_back(axes[i]->filters[filter]);
      entries[i].push_back(std::move(entry));
    }
  }
  ApplyDesign(designs.front(), stage, autopilot);
  const auto axes = axes_of(autopilot);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    std::vector<ScheduleEntry>& schedule = axes[i]->schedule;
    std::erase_if(schedule, [&](const ScheduleEntry& entry) { return entry.stage == stage + 1; });
    schedule.insert(schedule.end(), entries[i].begin(), entries[i].end());
    std::stable_sort(schedule.begin(), schedule.end(),
                     [](const ScheduleEntry& a, const ScheduleEntry& b) { return a.stage < b.stage; });
  }
}

std::vector<std::size_t> BlendedGyros(const AutopilotConfig& autopilot, int stage) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < autopilot.rate_gyros.size(); ++i)
    if (autopilot.rate_gyros[i].stage == stage + 1) found.push_back(i);
  if (found.size() != 2) found.clear();
  return found;
}

bool IsAugmented(const AutopilotConfig& autopilot) {
  return IsAugmented(autopilot.pitch) || IsAugmented(autopilot.yaw) || IsAugmented(autopilot.roll);
}

void ApplyDesign(const AugmentationDesign& design, AutopilotConfig& autopilot) {
  for (AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll}) {
    if (!IsAugmented(*axis)) continue;
    AdaptiveAugmentation& augmentation = axis->augmentation;
    augmentation.adaptive_gain_1_s = RoundToDigits(design.adaptive_gain_1_s, kDesignDigits);
    augmentation.spectral_gain_1_s = RoundToDigits(design.spectral_gain_1_s, kDesignDigits);
    augmentation.maximum_total_gain = RoundToDigits(design.maximum_total_gain, kDesignDigits);
  }
}

}  // namespace dispersa
