#include "core/results/requirement_text.h"

#include <fmt/format.h>

#include "core/results/text.h"

namespace dispersa {

Limits LimitsOf(const Requirement& requirement) {
  Limits limits;
  if (requirement.within) limits = {(*requirement.within)[0], (*requirement.within)[1]};
  if (requirement.above) limits.low = *requirement.above;
  if (requirement.below) limits.high = *requirement.below;
  return limits;
}

std::string LimitText(const Requirement& requirement) {
  const Limits limits = LimitsOf(requirement);
  if (requirement.within)
    return fmt::format("{} between {} and {}", requirement.metric, ShortestText(limits.low),
                       ShortestText(limits.high));
  return fmt::format("{} {} {}", requirement.metric, requirement.above ? "above" : "below",
                     ShortestText(requirement.above ? limits.low : limits.high));
}

std::string RequirementLine(const Requirement& requirement) {
  const Limits limits = LimitsOf(requirement);
  if (requirement.every_case)
    return fmt::format("{} above {} below {} every_case", requirement.metric, ShortestText(limits.low),
                       ShortestText(limits.high));
  const char* plan = requirement.plan.kind == PlanKind::kAnytime      ? "anytime"
                     : requirement.plan.spending == Spending::kPocock ? "pocock"
                                                                      : "obrien_fleming";
  const std::string& own = requirement.own_expression;
  return fmt::format("{} above {} below {} probability {} consumer_risk {} looks {} {}",
                     requirement.metric + (own.empty() ? "" : " = " + own), ShortestText(limits.low),
                     ShortestText(limits.high), ShortestText(requirement.probability),
                     ShortestText(requirement.consumer_risk), requirement.plan.looks, plan);
}

}  // namespace dispersa
