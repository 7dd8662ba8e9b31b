#include "core/analysis/likeness.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/campaign/plausible_dispersions.h"

namespace dispersa {

std::string WhyNoEvidence(const Campaign& campaign, const CaseColumns& cases) {
  if (cases.rows() < 2) return "";
  std::vector<SetInput> varied = SetInputs(campaign);
  std::erase_if(varied, [](const SetInput& input) { return !input.varies; });
  if (varied.empty())
    return fmt::format("No input varies from case to case: {} flights show no more than one.", cases.rows());
  if (std::all_of(varied.begin(), varied.end(), [](const SetInput& input) { return !input.unread.empty(); }))
    return fmt::format("No part of the flight reads what varies ({}: {}): {} flights show no more than one.",
                       varied.front().key, varied.front().unread, cases.rows());
  if (cases.are_alike)
    return fmt::format(
        "All {} flights are alike to the last bit, although their inputs vary: they show no more than one.",
        cases.rows());
  return "";
}

}  // namespace dispersa
