#include "core/report/limit_text.h"

#include <fmt/format.h>

#include "core/report/requirement_summary.h"
#include "core/report/text.h"

namespace dispersa {

std::string LimitText(const Requirement& requirement) {
  const Limits limits = LimitsOf(requirement);
  if (requirement.within)
    return fmt::format("{} between {} and {}", requirement.metric, ShortestText(limits.low),
                       ShortestText(limits.high));
  return fmt::format("{} {} {}", requirement.metric, requirement.above ? "above" : "below",
                     ShortestText(requirement.above ? limits.low : limits.high));
}

}  // namespace dispersa
