#include "services/cli/fly_scenario.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/fly_scenario.h"
#include "core/flight/history_columns.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "core/results/text.h"
#include "services/cli/stream_beside.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

std::string Csv(const std::vector<std::string>& columns, const std::vector<double>& rows) {
  std::string csv;
  for (std::size_t i = 0; i < columns.size(); ++i) csv += (i == 0 ? "" : ",") + columns[i];
  for (std::size_t i = 0; i < rows.size(); ++i)
    csv += (i % columns.size() == 0 ? "\n" : ",") + ShortestText(rows[i]);
  return csv + "\n";
}

}  // namespace

ExitCode FlyScenarioFile(const std::string& path, Scheme scheme, const std::string& history,
                         const GlobalOptions& global) {
  const Scenario scenario = LoadScenario(path);
  RequireWritableFile("--history", history);
  const ScenarioFlight flight = FlyScenario(scenario, scheme);
  const std::vector<std::string>& columns = KinematicColumnNames();
  const std::vector<double> rows = HistoryRows(scenario, flight.samples);
  if (!history.empty()) WriteFile(history, Csv(columns, rows));

  // The last row is the final state; its time is end_time_s.
  const std::size_t last = rows.size() - columns.size();
  if (global.json) {
    nlohmann::ordered_json metrics = nlohmann::ordered_json::object();
    for (std::size_t i = 1; i < columns.size(); ++i) metrics["final_" + columns[i]] = Number(rows[last + i]);
    const nlohmann::ordered_json json = {{"schema", "dispersa/fly/1"},
                                         {"scenario", scenario.name},
                                         {"outcome", OutcomeName(flight.outcome)},
                                         {"end_time_s", Number(flight.end_time_s)},
                                         {"end_stage", flight.samples.back().stage + 1},
                                         {"reason", flight.reason},
                                         {"inputs", nlohmann::ordered_json::object()},
                                         {"metrics", metrics},
                                         {"digest", flight.digest.Hex()}};
    fmt::print("{}\n", json.dump(2));
    return kExitDone;
  }
  std::FILE* const stream = StreamBeside("--history", history, global);
  fmt::print(stream, "outcome  {}\ndigest   {}\n", OutcomeName(flight.outcome), flight.digest.Hex());
  fmt::print(stream, "{:<44} {}\n", "end_time_s", ShortestText(flight.end_time_s));
  for (std::size_t i = 1; i < columns.size(); ++i)
    fmt::print(stream, "{:<44} {}\n", "metric_final_" + columns[i], ShortestText(rows[last + i]));
  return kExitDone;
}

}  // namespace dispersa
