// dispersa fly: one flight of a campaign, or a scenario, in this process.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/pages/histories.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "core/results/text.h"
#include "services/cli/command.h"
#include "services/cli/fly_scenario.h"
#include "services/cli/stream_beside.h"
#include "services/cli/warn.h"
#include "services/client/flight_json.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

struct FlyOptions {
  std::string campaign;
  CampaignOverrides overrides;
  std::optional<std::uint64_t> case_index;  ///< none: the nominal flight
  std::string history;
  std::string integrator;  ///< empty: the one that campaigns and scenarios fly
};

void PrintJson(const CaseResult& result, const RowInputs& rows, const Campaign& campaign) {
  auto in_rows = nlohmann::ordered_json::array();
  for (const std::size_t position : rows.positions()) in_rows.push_back(InputColumns()[position].name);
  const nlohmann::ordered_json json = {
      {"schema", "dispersa/fly/1"},
      {"outcome", OutcomeName(result.outcome)},
      {"end_time_s", Number(result.end_time_s)},
      {"end_stage", result.end_stage},
      {"reason", result.reason},
      {"inputs", InputsJson(rows, result)},
      {"row_inputs", std::move(in_rows)},
      {"inputs_digest", result.inputs_digest.Hex()},
      {"metrics", MetricsJson(result.metrics, MetricsOf(campaign), ResultMetrics(campaign))},
      {"digest", result.digest.Hex()},
      {"events", EventsJson(result.events)}};
  fmt::print("{}\n", json.dump(2));
}

void PrintText(std::FILE* stream, const CaseResult& result, const RowInputs& rows, const Campaign& campaign) {
  fmt::print(stream, "outcome  {}\ndigest   {}\n", OutcomeText(result), result.digest.Hex());
  const std::vector<double> nominal = InputValues(FlightInputs{}, kMaxStages + kFurtherNozzles);
  const std::vector<double> all = rows.AllOf(result.inputs);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == nominal[i]) continue;
    fmt::print(stream, "{:<44} {}\n", "input_" + InputColumns()[i].name, ReadableText(all[i]));
  }
  const MetricList metrics = MetricsOf(campaign);
  for (const std::size_t i : MeasuredMetrics(campaign)) {
    fmt::print(stream, "{:<44} {}\n", "metric_" + metrics.NameAt(i), ReadableText(result.metrics[i]));
  }
  for (const SeenEvent& event : result.events)
    fmt::print(stream, "{:<44} {} s, {} m, {} m/s, {} kg\n", "event_" + event.name,
               ReadableText(event.time_s), ReadableText(event.altitude_m), ReadableText(event.speed_m_s),
               ReadableText(event.mass_kg));
}

ExitCode FlyOne(const FlyOptions& options, const GlobalOptions& global) {
  std::FILE* const stream = StreamBeside("--history", options.history, global);
  const bool is_scenario = IsScenarioFile(options.campaign);
  Scheme scheme = is_scenario ? Scheme::kRungeKutta4 : Scheme::kSimpson;
  if (!options.integrator.empty()) ParseScheme(options.integrator, &scheme);
  if (is_scenario) {
    if (scheme == Scheme::kSimpson)
      throw InputError("--integrator: a scenario does not fly with 'simpson'", "erk4 or cvode");
    if (options.case_index || options.overrides.seed)
      throw InputError("--case, --seed: a scenario has no cases", "a campaign file with these options");
    if (options.overrides.autopilot)
      throw InputError("--autopilot: a scenario flies without one", "a campaign file with this option");
    return FlyScenarioFile(options.campaign, scheme, options.history, global);
  }
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  RequireWritableFile("--history", options.history);
  if (options.case_index && *options.case_index >= campaign.sampling.cases) {
    throw InputError("--case: the campaign has no case " + std::to_string(*options.case_index),
                     "0 to " + std::to_string(campaign.sampling.cases - 1));
  }
  const CampaignFlights flights(campaign);
  const FlightInputs inputs = options.case_index ? flights.Draw(*options.case_index) : FlightInputs{};
  History history;
  history.step_s = campaign.autopilot.tick_s;
  const CaseResult result = flights.Fly(inputs, options.case_index.value_or(0),
                                        options.history.empty() ? nullptr : &history, scheme);
  if (!options.history.empty()) WriteFile(options.history, HistoryCsv(history, campaign.autopilot));
  if (global.json) {
    PrintJson(result, flights.rows(), campaign);
  } else {
    PrintText(stream, result, flights.rows(), campaign);
  }
  return kExitDone;
}

}  // namespace

void AddFlyCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<FlyOptions>();
  CLI::App* command =
      app.add_subcommand("fly", "fly the nominal flight, one case, or a scenario, in this process");
  command->add_option("campaign", options->campaign, "campaign or scenario file")
      ->required()
      ->type_name(kYamlType);
  command->add_option("--case", options->case_index, "case index, from 0; without it the nominal flight");
  command
      ->add_option("--history", options->history,
                   "file for the time history with every tick, CSV; -: standard output")
      ->type_name(kFileType);
  command
      ->add_option("--integrator", options->integrator,
                   "simpson (default of campaigns), erk4 (default of scenarios: the classical Runge-Kutta "
                   "method of SUNDIALS) or cvode (high accuracy, for comparison)")
      ->type_name("{simpson,erk4,cvode}");
  command->add_option("--seed", options->overrides.seed, "seed, instead of the file's");
  command
      ->add_option("--autopilot", options->overrides.autopilot, "autopilot file, instead of the campaign's")
      ->type_name(kYamlType);
  command->footer(
      "Example: dispersa fly campaigns/nominal.yaml --history nominal.csv\n"
      "         dispersa fly campaigns/table3.yaml --case 17 --json\n"
      "         dispersa fly campaigns/scenarios/nesc_case09.yaml --history case09.csv");
  Bind(command, invocation, options, FlyOne);
}

}  // namespace dispersa
