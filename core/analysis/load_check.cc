#include "core/analysis/load_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/flight/metrics.h"
#include "core/flight/structural_limits.h"

namespace dispersa {
namespace {

constexpr char kAllLimits[] = "structural_limit_exceeded";

bool IsRequired(const Campaign& campaign, const StructuralLimit& one) {
  const double limit = campaign.vehicle.limits.*one.limit;
  return std::any_of(
      campaign.requirements.begin(), campaign.requirements.end(), [&](const Requirement& each) {
        return each.below && ((each.metric == kAllLimits && *each.below > 0.0 && *each.below <= 1.0) ||
                              (each.metric == one.metric && *each.below <= limit));
      });
}

enum class Held { kYes, kNotMeasured, kNo };

/// For each row the worst of all checked limits; empty if there is none to check.
std::vector<Held> HeldLimits(const Campaign& campaign, const CaseColumns& cases) {
  std::vector<Held> held;
  for (const StructuralLimit& one : AllStructuralLimits()) {
    const double limit = campaign.vehicle.limits.*one.limit;
    if (!(limit > 0.0) || IsRequired(campaign, one)) continue;
    const std::vector<double> loads = cases.metrics.at(MetricColumn(one.metric));
    held.resize(loads.size(), Held::kYes);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const bool is_open = cases.outcome[i] == Outcome::kCompleted && std::isnan(loads[i]);
      held[i] = std::max(held[i], loads[i] > limit ? Held::kNo : is_open ? Held::kNotMeasured : Held::kYes);
    }
  }
  return held;
}

}  // namespace

std::vector<bool> BeyondCheckedLimits(const Campaign& campaign, const CaseColumns& cases) {
  std::vector<bool> beyond;
  for (const Held held : HeldLimits(campaign, cases)) beyond.push_back(held != Held::kYes);
  return beyond;
}

std::vector<LoadCheck> CheckLoads(const Campaign& campaign, const CaseColumns& cases) {
  const std::vector<Held> held = HeldLimits(campaign, cases);
  if (held.empty()) return {};
  const std::int64_t not_measured = std::count(held.begin(), held.end(), Held::kNotMeasured);
  const std::int64_t beyond = std::count(held.begin(), held.end(), Held::kNo);
  return {{kAllLimits, std::ssize(held), beyond + not_measured, not_measured}};
}

std::string LoadCheckSentence(const LoadCheck& check) {
  const std::string open =
      check.not_measured > 0
          ? fmt::format(", and in {} completed its load is not measured", check.not_measured)
          : std::string();
  return fmt::format("Load check: {} of {} flight{} went beyond a limit of the vehicle{}. {}",
                     check.failures - check.not_measured, check.n, check.n == 1 ? "" : "s", open,
                     check.failures > 0 ? "No flight may."
                                        : "No requirement states how often that may happen, so this shows no "
                                          "probability.");
}

}  // namespace dispersa
