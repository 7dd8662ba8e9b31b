// dispersa replay: one stored case flown again, to the last bit.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "core/report/histories.h"
#include "core/report/output_file.h"
#include "core/report/text.h"
#include "services/cli/command.h"
#include "services/cli/flight_json.h"
#include "services/cli/stored_campaign.h"
#include "services/cli/writable.h"

namespace dispersa {
namespace {

struct ReplayOptions {
  std::string directory;
  std::uint64_t case_index = 0;
  std::string history;
};

struct Difference {
  std::string name;
  std::string stored;
  std::string replayed;
};

// As results store it: undefined is undefined, -0 is 0.
bool SameStored(double stored, double replayed) {
  if (!std::isfinite(stored) || !std::isfinite(replayed))
    return std::isfinite(stored) == std::isfinite(replayed);
  return std::bit_cast<std::uint64_t>(stored + 0.0) == std::bit_cast<std::uint64_t>(replayed + 0.0);
}

std::string Shown(double value) { return std::isfinite(value) ? ShortestText(value) : "undefined"; }

void CompareNumber(const std::string& name, double stored, double replayed,
                   std::vector<Difference>& differences) {
  if (!SameStored(stored, replayed)) differences.push_back({name, Shown(stored), Shown(replayed)});
}

void CompareText(const std::string& name, const std::string& stored, const std::string& replayed,
                 std::vector<Difference>& differences) {
  if (stored != replayed) differences.push_back({name, stored, replayed});
}

std::vector<Difference> Differences(const CaseResult& stored, const CaseResult& replayed) {
  std::vector<Difference> differences;
  CompareText("outcome", OutcomeName(stored.outcome), OutcomeName(replayed.outcome), differences);
  CompareText("reason", stored.reason, replayed.reason, differences);
  CompareNumber("end_time_s", stored.end_time_s, replayed.end_time_s, differences);
  CompareNumber("end_stage", stored.end_stage, replayed.end_stage, differences);
  for (std::size_t i = 0; i < stored.inputs.size(); ++i) {
    CompareNumber("input_" + InputColumns()[i].name, stored.inputs[i], replayed.inputs[i], differences);
  }
  for (std::size_t i = 0; i < stored.metrics.size(); ++i) {
    CompareNumber("metric_" + MetricNames()[i], stored.metrics[i], replayed.metrics[i], differences);
  }
  CompareText("digest", stored.digest.Hex(), replayed.digest.Hex(), differences);
  return differences;
}

void PrintJson(const CaseResult& stored, const CaseResult& replayed,
               const std::vector<Difference>& differences) {
  auto list = nlohmann::ordered_json::array();
  for (const Difference& difference : differences) {
    list.push_back(
        {{"name", difference.name}, {"stored", difference.stored}, {"replayed", difference.replayed}});
  }
  const nlohmann::ordered_json json = {
      {"schema", "dispersa/replay/1"},   {"case_index", stored.case_index},
      {"match", differences.empty()},    {"stored_digest", stored.digest.Hex()},
      {"digest", replayed.digest.Hex()}, {"differences", std::move(list)}};
  fmt::print("{}\n", json.dump(2));
}

void PrintText(const CaseResult& stored, const CaseResult& replayed,
               const std::vector<Difference>& differences) {
  fmt::print("case {}: {}, {}\ndigest {}\n", stored.case_index,
             differences.empty() ? "reproduced to the last bit" : "NOT reproduced", OutcomeText(replayed),
             replayed.digest.Hex());
  for (const Difference& difference : differences) {
    fmt::print("{:<44} stored {}, replayed {}\n", difference.name, difference.stored, difference.replayed);
  }
}

ExitCode Replay(const ReplayOptions& options, const GlobalOptions& global) {
  const StoredCampaign stored = OpenStored(options.directory);
  RequireWritableFile("--history", options.history);
  const std::string engine = stored.folder.Provenance("engine");
  if (engine != EngineVersion()) {
    spdlog::warn("the folder was flown by engine {}, this is {}: the flights may differ", engine,
                 EngineVersion());
  }
  const CaseResult result = stored.folder.Load(options.case_index);
  History history;
  const CaseResult replayed = CampaignFlights(stored.campaign)
                                  .FlyCase(options.case_index, options.history.empty() ? nullptr : &history);
  if (!options.history.empty()) WriteFile(options.history, HistoryCsv(history));
  const std::vector<Difference> differences = Differences(result, replayed);
  if (global.json) {
    PrintJson(result, replayed, differences);
  } else {
    PrintText(result, replayed, differences);
  }
  return differences.empty() ? kExitDone : kExitReplayMismatch;
}

}  // namespace

void AddReplayCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "fly a stored case again and compare it to the last bit");
  command->add_option("directory", options->directory, "result folder")->required()->type_name(kFolderType);
  command->add_option("--case", options->case_index, "case index, from 0")->required();
  command->add_option("--history", options->history, "file for the time history, CSV")->type_name(kFileType);
  command->footer("Example: dispersa replay results/table3-1a2b3c4d --case 17 --history case17.csv");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Replay(*options, global); };
  });
}

}  // namespace dispersa
