// dispersa replay: one stored case flown again, to the last bit.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/pages/histories.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/cli/stream_beside.h"
#include "services/client/case_replay.h"
#include "services/client/flight_json.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

struct ReplayOptions {
  std::string directory;
  std::uint64_t case_index = 0;
  std::string history;
};

void PrintText(std::FILE* stream, const CaseResult& stored, const CaseResult& replayed,
               const std::vector<ResultDifference>& differences) {
  fmt::print(stream, "case {}: {}, {}\ndigest {}\n", stored.case_index,
             differences.empty() ? "reproduced to the last bit" : "NOT reproduced", OutcomeText(replayed),
             replayed.digest.Hex());
  for (const ResultDifference& difference : differences) {
    fmt::print(stream, "{:<44} stored {}, replayed {}\n", difference.name, difference.first,
               difference.second);
  }
}

ExitCode Replay(const ReplayOptions& options, const GlobalOptions& global) {
  const StoredCampaign stored = OpenStored(options.directory);
  std::FILE* const stream = StreamBeside("--history", options.history, global);
  RequireWritableFile("--history", options.history);
  History history;
  history.step_s = stored.campaign.autopilot.tick_s;
  const CaseReplay replay =
      ReplayCase(stored, options.case_index, options.history.empty() ? nullptr : &history);
  if (!options.history.empty()) WriteFile(options.history, HistoryCsv(history, stored.campaign.autopilot));
  if (global.json) {
    fmt::print("{}\n", ReplayJson(replay).dump(2));
  } else {
    PrintText(stream, replay.stored, replay.replayed, replay.differences);
  }
  return replay.differences.empty() ? kExitDone : kExitReplayMismatch;
}

}  // namespace

void AddReplayCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "fly a stored case again and compare it bit by bit");
  command->add_option("directory", options->directory, "result folder")->required()->type_name(kFolderType);
  command->add_option("--case", options->case_index, "case index, from 0")->required();
  command->add_option("--history", options->history, "file for the time history, CSV; -: standard output")
      ->type_name(kFileType);
  command->footer("Example: dispersa replay results/table3-1a2b3c4d --case 17 --history case17.csv");
  Bind(command, invocation, options, Replay);
}

}  // namespace dispersa
