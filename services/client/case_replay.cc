#include "services/client/case_replay.h"

#include <utility>

#include "core/cases/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "services/log/log.h"

namespace dispersa {

CaseReplay ReplayCase(const StoredCampaign& stored, std::uint64_t case_index, History* history) {
  const std::string engine = stored.folder.Provenance("engine");
  if (engine != EngineVersion()) {
    LogWarning("the folder was flown by engine {}, this is {}: the flights may differ", engine,
               EngineVersion());
  }
  CaseReplay replay;
  replay.stored = stored.folder.Load(case_index);
  replay.replayed = CampaignFlights(stored.campaign).FlyCase(case_index, history);
  replay.differences = Differences(replay.stored, replay.replayed, MetricsOf(stored.campaign));
  return replay;
}

nlohmann::ordered_json ReplayJson(const CaseReplay& replay) {
  auto list = nlohmann::ordered_json::array();
  for (const ResultDifference& difference : replay.differences) {
    list.push_back(
        {{"name", difference.name}, {"stored", difference.first}, {"replayed", difference.second}});
  }
  return {{"schema", "dispersa/replay/1"},          {"case_index", replay.stored.case_index},
          {"match", replay.differences.empty()},    {"stored_digest", replay.stored.digest.Hex()},
          {"digest", replay.replayed.digest.Hex()}, {"differences", std::move(list)}};
}

}  // namespace dispersa
