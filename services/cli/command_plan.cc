// dispersa plan: what every case would fly with, without flying.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/report/text.h"
#include "services/cli/command.h"
#include "services/cli/flight_json.h"
#include "services/cli/warn.h"

namespace dispersa {
namespace {

struct PlanOptions {
  std::string campaign;
  CampaignOverrides overrides;
  bool csv = false;
};

// Positions of the inputs that the campaign disperses, ascending.
std::vector<std::size_t> DispersedColumns(const Campaign& campaign) {
  std::vector<std::size_t> columns;
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) columns.push_back(static_cast<std::size_t>(input));
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

void PrintCsv(const Campaign& campaign, const CaseDesign& design) {
  std::string line = "case_index";
  for (const InputColumn& column : InputColumns()) line += ",input_" + column.name;
  fmt::print("{}\n", line);
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    line = std::to_string(index);
    for (const double value : InputValues(design.Draw(index))) line += "," + ShortestText(value);
    fmt::print("{}\n", line);
  }
}

void PrintJson(const Campaign& campaign, const CaseDesign& design) {
  auto cases = nlohmann::ordered_json::array();
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    cases.push_back({{"case_index", index}, {"inputs", InputsJson(InputValues(design.Draw(index)))}});
  }
  const nlohmann::ordered_json plan = {{"schema", "dispersa/plan/1"},
                                       {"id", campaign.id},
                                       {"flight_id", campaign.flight_id},
                                       {"cases", std::move(cases)}};
  fmt::print("{}\n", plan.dump(2));
}

void PrintTable(const Campaign& campaign, const CaseDesign& design) {
  const std::vector<std::size_t> columns = DispersedColumns(campaign);
  fmt::print("{}: {} cases, seed {}, {} dispersed inputs\n", campaign.name, campaign.sampling.cases,
             campaign.sampling.seed, columns.size());
  std::vector<std::size_t> widths;
  std::string line = fmt::format("{:>8}", "case");
  for (const std::size_t column : columns) {
    const std::string& name = InputColumns()[column].name;
    widths.push_back(std::max<std::size_t>(name.size(), 10));
    line += fmt::format("  {:>{}}", name, widths.back());
  }
  fmt::print("{}\n", line);
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    const std::vector<double> values = InputValues(design.Draw(index));
    line = fmt::format("{:>8}", index);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      line += fmt::format("  {:>{}.6g}", values[columns[i]], widths[i]);
    }
    fmt::print("{}\n", line);
  }
}

ExitCode Plan(const PlanOptions& options, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  const CaseDesign design(campaign);
  if (global.json) {
    PrintJson(campaign, design);
  } else if (options.csv) {
    PrintCsv(campaign, design);
  } else {
    PrintTable(campaign, design);
  }
  return kExitDone;
}

}  // namespace

void AddPlanCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "print the inputs of every case, without flying");
  command->add_option("campaign", options->campaign, "campaign file")->required();
  command->add_option("--cases", options->overrides.cases, "number of cases, instead of the file's")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->overrides.seed, "seed, instead of the file's");
  command->add_flag("--csv", options->csv, "all inputs, in the columns of cases.csv");
  command->footer("Example: dispersa plan campaigns/table3.yaml --cases 20 --csv");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Plan(*options, global); };
  });
}

}  // namespace dispersa
