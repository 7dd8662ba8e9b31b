// An observer with Cyclone DDS: knows the coordinator's address and nothing else, and follows a campaign.
//
// usage: cyclone_observer DOMAIN CAMPAIGN
// Prints one JSON object a line: {"progress": ...} or {"result": ...}. Ends with 0 when the campaign has
// ended and all of its results are there, with 1 when it has ended and they do not come.
#include <cstdint>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "cyclone.h"
#include "dispersion.h"

namespace {

using Json = nlohmann::ordered_json;

constexpr dds_duration_t kRound = DDS_MSECS(50);
/// Results and progress are different topics: after the end a result may still be on its way for so long.
constexpr dds_duration_t kPatience = DDS_SECS(30);

Json ToJson(const dispersa_idl_ProgressV1& progress) {
  return {{"campaign_id", progress.campaign_id},
          {"flight_id", progress.flight_id},
          {"name", progress.name},
          {"state", progress.state},
          {"total", progress.total},
          {"done", progress.done},
          {"quarantined", progress.quarantined},
          {"assigned", progress.assigned},
          {"workers", progress.workers}};
}

// NaN, which is undefined, becomes null.
Json Doubles(const dds_sequence_double& sequence) {
  return std::vector<double>(sequence._buffer, sequence._buffer + sequence._length);
}

Json ToJson(const dispersa_idl_ResultV2& result) {
  const dispersa_idl_FlownCaseV3& flown = result.flown;
  Json events = Json::array();
  for (std::uint32_t i = 0; i < flown.events._length; ++i) {
    const dispersa_idl_SeenEventV1& event = flown.events._buffer[i];
    events.push_back(
        {event.name, event.time_s, event.altitude_m, event.speed_m_s, event.qbar_pa, event.mass_kg});
  }
  return {{"flight_id", result.flight_id},
          {"worker", result.worker},
          {"case_index", flown.case_index},
          {"outcome", flown.outcome},
          {"end_time_s", flown.end_time_s},
          {"end_stage", flown.end_stage},
          {"reason", flown.reason},
          {"inputs", Doubles(flown.inputs)},
          {"metrics", Doubles(flown.metrics)},
          {"inputs_digest_high", flown.inputs_digest_high},
          {"inputs_digest_low", flown.inputs_digest_low},
          {"digest_high", flown.digest_high},
          {"digest_low", flown.digest_low},
          {"events", std::move(events)}};
}

bool HasEnded(const std::string& state) {
  return state == "done" || state == "cancelled" || state == "failed" || state == "refused";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string campaign = argv[2];
  const dds_entity_t participant = cyclone::Join(std::atoi(argv[1]));
  // In this order: the coordinator, too, learns of the readers in it, so who hears of the progress misses no
  // result from then on.
  const dds_entity_t results = cyclone::Reader(participant, dispersa_idl_ResultV2_desc);
  const dds_entity_t progresses = cyclone::Reader(participant, dispersa_idl_ProgressV1_desc);

  std::map<std::string, std::uint64_t> count;  // of results, by flight id
  std::string flight_id;
  std::uint64_t done = 0;
  std::optional<dds_time_t> ended;
  while (!ended || count[flight_id] < done) {
    dds_sleepfor(kRound);
    cyclone::TakeAll<dispersa_idl_ResultV2>(results, [&](const dispersa_idl_ResultV2& result) {
      ++count[result.flight_id];
      std::cout << Json{{"result", ToJson(result)}}.dump() << std::endl;
    });
    cyclone::TakeAll<dispersa_idl_ProgressV1>(progresses, [&](const dispersa_idl_ProgressV1& progress) {
      std::cout << Json{{"progress", ToJson(progress)}}.dump() << std::endl;
      if (progress.campaign_id != campaign) return;
      flight_id = progress.flight_id;
      done = progress.done;
      if (HasEnded(progress.state)) ended = dds_time();
    });
    if (ended && dds_time() - *ended > kPatience) break;
  }
  dds_delete(participant);
  return count[flight_id] < done ? 1 : 0;
}
