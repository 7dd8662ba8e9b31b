#include "core/analysis/load_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/flight/metrics.h"
#include "core/flight/structural_limits.h"

namespace dispersa {
namespace {

constexpr char kAllLimits[] = "structural_limit_exceeded";

bool IsRequired(const Campaign& campaign, const StructuralLimit& one) {
  const double limit = campaign.vehicle.limits.*one.limit;
  return std::any_of(campaign.requirements.begin(), campaign.requirements.end(), [&](const Requirement& each) {
    return each.below && ((each.metric == kAllLimits && *each.below > 0.0 && *each.below <= 1.0) ||
                          (each.metric == one.metric && *each.below <= limit));
  });
}

}  // namespace

std::vector<bool> BeyondCheckedLimits(const Campaign& campaign, const CaseColumns& cases) {
  std::vector<bool> beyond;
  for (const StructuralLimit& one : AllStructuralLimits()) {
    const double limit = campaign.vehicle.limits.*one.limit;
    if (!(limit > 0.0) || IsRequired(campaign, one)) continue;
    const std::vector<double> loads = cases.metrics.at(MetricColumn(one.metric));
    beyond.resize(loads.size());
    for (std::size_t i = 0; i < loads.size(); ++i) beyond[i] = beyond[i] || loads[i] > limit;
  }
  return beyond;
}

std::vector<LoadCheck> CheckLoads(const Campaign& campaign, const CaseColumns& cases) {
  const std::vector<bool> beyond = BeyondCheckedLimits(campaign, cases);
  if (beyond.empty()) return {};
  return {{kAllLimits, std::ssize(beyond), std::count(beyond.begin(), beyond.end(), true)}};
}

std::string LoadCheckSentence(const LoadCheck& check) {
  return fmt::format("Load check: {} of {} flight{} went beyond a limit of the vehicle. {}", check.failures,
                     check.n, check.n == 1 ? "" : "s",
                     check.failures > 0 ? "No flight may."
                                        : "No requirement states how often that may happen, so this shows no "
                                          "probability.");
}

}  // namespace dispersa
