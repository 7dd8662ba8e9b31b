#include "core/results/requirement_text.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

#include "core/results/metric_catalogue.h"
#include "core/results/text.h"

namespace dispersa {

Limits LimitsOf(const Requirement& requirement) {
  Limits limits;
  if (requirement.within) limits = {(*requirement.within)[0], (*requirement.within)[1], {}};
  if (requirement.above) limits.low = *requirement.above;
  if (requirement.below) limits.high = *requirement.below;
  limits.circle = CircleOf(requirement.metric);
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

std::optional<Requirement> RequirementOfLine(const std::string& line) {
  // From the right: an own expression may hold any of the words.
  const std::size_t above = line.rfind(" above "), below = line.rfind(" below ");
  if (above == std::string::npos || below == std::string::npos || below < above + 6) return std::nullopt;
  Requirement requirement;
  requirement.metric = line.substr(0, above);
  if (const std::size_t own = requirement.metric.find(" = "); own != std::string::npos) {
    requirement.own_expression = requirement.metric.substr(own + 3);
    requirement.metric.resize(own);
  }
  const auto number = [](const std::string& text, double* value) {
    const auto read = std::from_chars(text.data(), text.data() + text.size(), *value);
    return read.ec == std::errc() && read.ptr == text.data() + text.size();
  };
  double low = 0.0, high = 0.0;
  const bool has_low = below > above + 7 && number(line.substr(above + 7, below - above - 7), &low);
  const std::size_t end = line.find(' ', below + 7);
  if (end == std::string::npos) return std::nullopt;
  const bool has_high = number(line.substr(below + 7, end - below - 7), &high);
  if (has_low && has_high)
    requirement.within = {{low, high}};
  else if (has_high)
    requirement.below = high;
  else if (has_low)
    requirement.above = low;
  else
    return std::nullopt;
  std::istringstream rest(line.substr(end));
  std::string key, probability, risk, plan;
  rest >> key;
  if (key == "every_case") {
    requirement.every_case = true;
    return requirement;
  }
  rest >> probability >> key >> risk >> key >> requirement.plan.looks >> plan;
  if (!rest || !number(probability, &requirement.probability) || !number(risk, &requirement.consumer_risk))
    return std::nullopt;
  requirement.plan.kind = plan == "anytime"            ? PlanKind::kAnytime
                          : requirement.plan.looks > 1 ? PlanKind::kGroupSequential
                                                       : PlanKind::kFixed;
  if (plan == "pocock") requirement.plan.spending = Spending::kPocock;
  return requirement;
}

std::string LineWords(const std::string& line) {
  const std::optional<Requirement> requirement = RequirementOfLine(line);
  if (!requirement) return line;
  if (requirement->every_case) return LimitText(*requirement) + " in every case";
  std::string words =
      fmt::format("{} for {} of flights at {} risk", LimitText(*requirement),
                  PercentText(requirement->probability), PercentText(requirement->consumer_risk));
  if (requirement->plan.kind == PlanKind::kAnytime) words += ", judged at any time";
  if (requirement->plan.kind == PlanKind::kGroupSequential)
    words += fmt::format(", judged {} times", requirement->plan.looks);
  return words;
}

}  // namespace dispersa
