#include "services/cli/plan_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/campaign/case_design.h"
#include "core/flight/flight_inputs.h"
#include "core/report/dispersion_summary.h"

namespace dispersa {
namespace {

constexpr std::size_t kNumberWidth = 13, kCaseWidth = 8;

/// Of the inputs that any dispersion feeds; the others stay empty.
CaseColumns DrawnColumns(const Campaign& campaign, const std::vector<int>& inputs) {
  const CaseDesign design(campaign);
  CaseColumns cases;
  const std::size_t stages = campaign.vehicle.stages.size();
  cases.inputs.resize(InputCount(stages));
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    cases.index.push_back(index);
    const std::vector<double> values = InputValues(design.Draw(index), stages);
    for (const int input : inputs) {
      const auto column = static_cast<std::size_t>(input);
      cases.inputs[column].push_back(values[column]);
    }
  }
  return cases;
}

std::string Number(double value) { return fmt::format("{:>{}.6g}", value, kNumberWidth); }

/// The columns from one input to before another.
std::string Block(const std::vector<std::vector<double>>& columns, std::size_t from, std::size_t to) {
  std::string text = fmt::format("\n{:>{}}", "case", kCaseWidth);
  for (std::size_t i = from; i < to; ++i)
    text += fmt::format("{:>{}}", fmt::format("[{}]", i + 1), kNumberWidth);
  text += "\n";
  for (std::size_t index = 0; index < columns[from].size(); ++index) {
    text += fmt::format("{:>{}}", index, kCaseWidth);
    for (std::size_t i = from; i < to; ++i) text += Number(columns[i][index]);
    text += "\n";
  }
  return text;
}

std::string SummaryLines(std::size_t number, const DispersionSummary& one) {
  const Summary& drawn = one.drawn;
  return fmt::format(
      "\n[{}] {}\n    {}{}\n    drawn: mean {:.6g}, standard deviation {:.4g}, {:.6g} to {:.6g}\n", number,
      one.input, one.declared,
      !one.consistent   ? ""
      : *one.consistent ? ", as drawn"
                        : ": THE DRAWS DO NOT AGREE",
      drawn.mean, drawn.std, drawn.min, drawn.max);
}

}  // namespace

std::string PlanText(const Campaign& campaign, std::uint64_t shown, std::size_t width) {
  const std::vector<int> inputs = DispersedInputs(campaign);
  const CaseColumns cases = DrawnColumns(campaign, inputs);
  std::string text = fmt::format("{}: {} cases, seed {}, {} dispersed inputs\n", campaign.name,
                                 campaign.sampling.cases, campaign.sampling.seed, inputs.size());
  std::vector<std::vector<double>> columns;
  for (const int input : inputs) {
    const CaseColumn& all = cases.inputs[static_cast<std::size_t>(input)];
    columns.emplace_back();
    for (std::uint64_t index = 0; index < std::min<std::uint64_t>(shown, cases.rows()); ++index)
      columns.back().push_back(all[index]);
  }
  const std::size_t in_a_block = (std::max<std::size_t>(width, 80) - kCaseWidth) / kNumberWidth;
  for (std::size_t from = 0; from < columns.size(); from += in_a_block)
    text += Block(columns, from, std::min(columns.size(), from + in_a_block));
  if (shown < cases.rows()) text += fmt::format("\nThe first {} cases; --csv prints them all.\n", shown);

  const std::vector<DispersionSummary> summaries = SummarizeDispersions(campaign, cases);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string& name = InputColumns()[static_cast<std::size_t>(inputs[i])].name;
    for (const DispersionSummary& one : summaries)
      if (one.input == name) text += SummaryLines(i + 1, one);
  }
  return text;
}

}  // namespace dispersa
