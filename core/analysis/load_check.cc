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

/// For each row whether fails(load, limit, outcome) of any checked limit; empty if there is none to check.
template <typename Fails>
std::vector<bool> AnyLimit(const Campaign& campaign, const CaseColumns& cases, Fails fails) {
  std::vector<bool> any;
  for (const StructuralLimit& one : AllStructuralLimits()) {
    const double limit = campaign.vehicle.limits.*one.limit;
    if (!(limit > 0.0) || IsRequired(campaign, one)) continue;
    const std::vector<double> loads = cases.metrics.at(MetricColumn(one.metric));
    any.resize(loads.size());
    for (std::size_t i = 0; i < loads.size(); ++i)
      any[i] = any[i] || fails(loads[i], limit, cases.outcome[i]);
  }
  return any;
}

bool IsNotMeasured(double load, double, Outcome outcome) {
  return outcome == Outcome::kCompleted && std::isnan(load);
}

}  // namespace

std::vector<bool> BeyondCheckedLimits(const Campaign& campaign, const CaseColumns& cases) {
  return AnyLimit(campaign, cases, [](double load, double limit, Outcome outcome) {
    return load > limit || IsNotMeasured(load, limit, outcome);
  });
}

std::vector<LoadCheck> CheckLoads(const Campaign& campaign, const CaseColumns& cases) {
  const std::vector<bool> beyond = BeyondCheckedLimits(campaign, cases);
  if (beyond.empty()) return {};
  const std::vector<bool> not_measured = AnyLimit(campaign, cases, IsNotMeasured);
  return {{kAllLimits, std::ssize(beyond), std::count(beyond.begin(), beyond.end(), true),
           std::count(not_measured.begin(), not_measured.end(), true)}};
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
