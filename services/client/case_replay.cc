#include "services/client/case_replay.h"

#include <bit>
#include <cmath>
#include <utility>

#include "core/campaign/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/report/text.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

// As results store it: undefined is undefined, -0 is 0.
bool SameStored(double stored, double replayed) {
  if (!std::isfinite(stored) || !std::isfinite(replayed))
    return std::isfinite(stored) == std::isfinite(replayed);
  return std::bit_cast<std::uint64_t>(stored + 0.0) == std::bit_cast<std::uint64_t>(replayed + 0.0);
}

std::string Shown(double value) { return std::isfinite(value) ? ShortestText(value) : "undefined"; }

void CompareNumber(const std::string& name, double stored, double replayed,
                   std::vector<ReplayDifference>& differences) {
  if (!SameStored(stored, replayed)) differences.push_back({name, Shown(stored), Shown(replayed)});
}

void CompareText(const std::string& name, const std::string& stored, const std::string& replayed,
                 std::vector<ReplayDifference>& differences) {
  if (stored != replayed) differences.push_back({name, stored, replayed});
}

std::vector<ReplayDifference> Differences(const CaseResult& stored, const CaseResult& replayed) {
  std::vector<ReplayDifference> differences;
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

}  // namespace

CaseReplay ReplayCase(const StoredCampaign& stored, std::uint64_t case_index, History* history) {
  const std::string engine = stored.folder.Provenance("engine");
  if (engine != EngineVersion()) {
    LogWarning("the folder was flown by engine {}, this is {}: the flights may differ", engine,
               EngineVersion());
  }
  CaseReplay replay;
  replay.stored = stored.folder.Load(case_index);
  replay.replayed = CampaignFlights(stored.campaign).FlyCase(case_index, history);
  replay.differences = Differences(replay.stored, replay.replayed);
  return replay;
}

nlohmann::ordered_json ReplayJson(const CaseReplay& replay) {
  auto list = nlohmann::ordered_json::array();
  for (const ReplayDifference& difference : replay.differences) {
    list.push_back(
        {{"name", difference.name}, {"stored", difference.stored}, {"replayed", difference.replayed}});
  }
  return {
      {"schema", "dispersa/replay/1"},   {"case_index", replay.stored.case_index},
      {"match", replay.differences.empty()},    {"stored_digest", replay.stored.digest.Hex()},
      {"digest", replay.replayed.digest.Hex()}, {"differences", std::move(list)}};
}

}  // namespace dispersa
