#include "services/client/case_replay.h"

#include <utility>

#include "core/cases/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "core/results/json_number.h"
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
  const CampaignFlights flights(stored.campaign);
  const RowInputs& rows = stored.folder.inputs();
  replay.replayed = flights.FlyCase(case_index, history);
  // Rows of an older release hold all inputs.
  if (rows.positions() != flights.rows().positions())
    SetInputs(rows, flights.rows().AllOf(replay.replayed.inputs), replay.replayed);
  replay.differences = Differences(replay.stored, replay.replayed, rows, MetricsOf(stored.campaign));
  return replay;
}

nlohmann::ordered_json ReplayJson(const CaseReplay& replay) {
  const auto difference_json = [](const ResultDifference& one) -> nlohmann::ordered_json {
    return {{"name", one.name}, {"stored", one.first}, {"replayed", one.second}};
  };
  return {
      {"schema", "dispersa/replay/1"},          {"case_index", replay.stored.case_index},
      {"match", replay.differences.empty()},    {"stored_digest", replay.stored.digest.Hex()},
      {"digest", replay.replayed.digest.Hex()}, {"differences", ListOf(replay.differences, difference_json)}};
}

}  // namespace dispersa
