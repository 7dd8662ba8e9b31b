// dispersa plan: what every case would fly with, without flying.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/campaign/case_design.h"
#include "core/campaign/row_inputs.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "core/results/text.h"
#include "services/cli/command.h"
#include "services/cli/plan_text.h"
#include "services/cli/terminal.h"
#include "services/cli/warn.h"
#include "services/client/flight_json.h"
#include "services/program/option_values.h"

namespace dispersa {
namespace {

struct PlanOptions {
  std::string campaign;
  CampaignOverrides overrides;
  bool csv = false;
  bool all = false;
};

constexpr std::size_t kUsualWidth = 100;

void PrintCsv(const Campaign& campaign, const CaseDesign& design) {
  std::string line = "case_index";
  const RowInputs rows(campaign);
  for (const std::size_t i : rows.positions()) line += ",input_" + InputColumns()[i].name;
  fmt::print("{}\n", line);
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    line = std::to_string(index);
    for (const double value : rows.RowOf(InputValues(design.Draw(index), rows.column_class())))
      line += "," + ShortestText(value);
    fmt::print("{}\n", line);
  }
}

std::string Indented(const std::string& lines) {
  std::string text;
  for (const char c : lines) {
    text += c;
    if (c == '\n') text.append(4, ' ');
  }
  return text;
}

void PrintJson(const Campaign& campaign, const CaseDesign& design) {
  const RowInputs rows(campaign);
  const nlohmann::ordered_json plan = {{"schema", "dispersa/plan/1"},
                                       {"id", campaign.id},
                                       {"flight_id", campaign.flight_id},
                                       {"cases", nlohmann::ordered_json::array()}};
  // Case by case, since no memory holds four billion of them: between the brackets of "cases": []\n}.
  const std::string around = plan.dump(2);
  const std::size_t inside = around.rfind(']');
  fmt::print("{}", around.substr(0, inside));
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    const nlohmann::ordered_json one = {
        {"case_index", index},
        {"inputs",
         InputsJson(rows.positions(), rows.RowOf(InputValues(design.Draw(index), rows.column_class())))}};
    fmt::print("{}\n    {}", index == 0 ? "" : ",", Indented(one.dump(2)));
  }
  fmt::print("\n  {}\n", around.substr(inside));
}

ExitCode Plan(const PlanOptions& options, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  const CaseDesign design(campaign);
  if (global.json) {
    PrintJson(campaign, design);
  } else if (options.csv) {
    PrintCsv(campaign, design);
  } else {
    fmt::print("{}", PlanText(campaign, options.all, TerminalWidth(STDOUT_FILENO, kUsualWidth)));
  }
  return kExitDone;
}

}  // namespace

void AddPlanCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "print the inputs of every case, without flying");
  command->add_option("campaign", options->campaign, "campaign file")->required()->type_name(kYamlType);
  command->add_option("--cases", options->overrides.cases, "number of cases, instead of the file's")
      ->transform(WholeNumber(1, kMostCases));
  command->add_option("--seed", options->overrides.seed, "seed, instead of the file's");
  command->add_flag("--csv", options->csv, "the inputs of each case, in the columns of cases.csv");
  command->add_flag("--all", options->all,
                    "every dispersed input of every case, without the limit to one screen");
  command->footer(
      "Prints the declared and the drawn distribution of each dispersed input, then its values in the first "
      "cases.\n"
      "Example: dispersa plan campaigns/table3.yaml --cases 20 --csv");
  Bind(command, invocation, options, Plan);
}

}  // namespace dispersa
