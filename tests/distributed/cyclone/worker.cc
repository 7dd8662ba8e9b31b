// A worker with Cyclone DDS: flies one assignment, whatever its size, and leaves when its results are stored.
//
// usage: cyclone_worker DOMAIN NAME DISPERSA FILE
// DISPERSA is the program that flies its cases, FILE where the campaign's text is put for it. Says on
// standard output what happens: "assigned", "flown", "stored". What it repeats, and until when, is
// services/README.md's table.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <future>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cyclone.h"
#include "dispersion.h"

namespace {

using Json = nlohmann::ordered_json;

constexpr dds_duration_t kRound = DDS_MSECS(50);
constexpr dds_duration_t kStatusPeriod = DDS_MSECS(500);
constexpr dds_duration_t kRepetition = DDS_SECS(2);

struct Flown {
  std::string outcome, reason;
  double end_time_s = 0.0;
  std::int32_t end_stage = 0;
  std::vector<double> inputs, metrics;
  std::uint64_t inputs_digest[2], digest[2];  ///< high, low
  std::vector<std::string> names;             ///< of the events
  std::vector<dispersa_idl_SeenEventV1> events;
};

struct Assignment {
  std::uint64_t epoch = 0, attempt = 0;
  std::string flight_id;
  std::vector<std::uint64_t> cases;
};

/// The output of a program.
Json Output(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  if (pclose(pipe) != 0) throw std::runtime_error(command + ": failed");
  return Json::parse(text);
}

std::vector<double> Doubles(const Json& object) {
  std::vector<double> values;
  for (const Json& value : object) {
    values.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  }
  return values;
}

std::uint64_t Half(const Json& digest, std::size_t half) {
  return std::stoull(digest.get<std::string>().substr(16 * half, 16), nullptr, 16);
}

Flown Fly(const std::string& dispersa, const std::string& file, std::uint64_t case_index) {
  const Json json = Output(dispersa + " fly " + file + " --case " + std::to_string(case_index) + " --json");
  Json in_row = Json::array();
  for (const Json& name : json.at("row_inputs"))
    in_row.push_back(json.at("inputs").at(name.get<std::string>()));
  Flown flown = {json.at("outcome"),
                 json.at("reason"),
                 json.at("end_time_s"),
                 json.at("end_stage"),
                 Doubles(in_row),
                 Doubles(json.at("metrics")),
                 {Half(json.at("inputs_digest"), 0), Half(json.at("inputs_digest"), 1)},
                 {Half(json.at("digest"), 0), Half(json.at("digest"), 1)},
                 {},
                 {}};
  for (const Json& event : json.at("events")) {
    const auto value = [&](const char* name) { return Doubles(Json::array({event.at(name)})).front(); };
    flown.names.push_back(event.at("event"));
    flown.events.push_back({nullptr, value("time_s"), value("altitude_m"), value("speed_m_s"),
                            value("qbar_pa"), value("mass_kg")});
  }
  return flown;
}

/// A sequence of the middleware over what somebody else owns.
template <typename Sequence, typename T>
Sequence View(std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size());
  return {size, size, values.data(), false};
}
char* View(const std::string& text) { return const_cast<char*>(text.c_str()); }

struct Worker {
  Worker(int domain, const std::string& name_, std::string dispersa_, std::string file_)
      : name(name_),
        dispersa(std::move(dispersa_)),
        file(std::move(file_)),
        engine_version(Output(dispersa + " --version --json").at("engine")),
        participant(cyclone::Join(domain)),
        orders(cyclone::Reader(participant, dispersa_idl_OrdersV1_desc, "w" + name)),
        texts(cyclone::Reader(participant, dispersa_idl_TextV1_desc, "w" + name)),
        statuses(cyclone::Writer(participant, dispersa_idl_WorkerStatusV2_desc)),
        reports(cyclone::Writer(participant, dispersa_idl_ReportV3_desc)),
        requests(cyclone::Writer(participant, dispersa_idl_TextRequestV1_desc)) {}

  void On(const dispersa_idl_OrdersV1& said) {
    if (*said.refusal != '\0') {
      std::cerr << "refused: " << said.refusal << "\n";
      std::exit(1);
    }
    // Another start of the coordinator knows nothing of what the last one wanted.
    if (said.coordinator_epoch != epoch && !Begun()) assignment.reset();
    epoch = said.coordinator_epoch;
    for (std::uint32_t i = 0; i < said.acknowledged._length; ++i)
      stored |= said.acknowledged._buffer[i] == kReport;
    for (std::uint32_t i = 0; i < said.revoked._length && assignment && !Begun(); ++i) {
      if (said.revoked._buffer[i] == assignment->attempt) assignment.reset();
    }
    for (std::uint32_t i = 0; i < said.assignments._length && !assignment; ++i) {
      const dispersa_idl_AssignmentV2& given = said.assignments._buffer[i];
      const auto& indices = given.case_indices;
      if (flight_id != given.flight_id) text.clear(), complete = false;
      flight_id = given.flight_id;
      assignment = {epoch, given.attempt, flight_id, {indices._buffer, indices._buffer + indices._length}};
      std::cout << "assigned " << indices._length << std::endl;
    }
  }

  /// From then on the assignment is flown and reported, whatever the coordinator says.
  bool Begun() const { return flights.valid() || !flown.empty(); }

  void On(const dispersa_idl_TextV1& part) {
    if (part.flight_id != flight_id || part.offset != text.size() || complete) return;
    text.append(reinterpret_cast<const char*>(part.bytes._buffer), part.bytes._length);
    requested = 0;
    complete = text.size() == part.size;
    if (!complete) return;
    std::ofstream(file, std::ios::binary) << text;
  }

  void SayStatus(dispersa_idl_WorkerStateV2 state) {
    std::vector<std::uint64_t> held;
    if (assignment && assignment->epoch == epoch) held.push_back(assignment->attempt);
    std::vector<dispersa_idl_StartedCaseV2> started = Started();
    dispersa_idl_WorkerStatusV2 status{};
    status.worker = View(name);
    status.host = View(host);
    status.engine_version = View(engine_version);
    status.slots = status.credits = 1;
    status.state = state;
    status.flown = flown.size();
    status.coordinator_epoch = epoch;
    status.held = View<dds_sequence_uint64>(held);
    status.started = View<dds_sequence_dispersa_idl_StartedCaseV2>(started);
    cyclone::Check(dds_write(statuses, &status), "status");
  }

  /// Being flown now.
  std::vector<dispersa_idl_StartedCaseV2> Started() const {
    std::vector<dispersa_idl_StartedCaseV2> started;
    if (!flights.valid()) return started;
    for (const std::uint64_t case_index : assignment->cases)
      started.push_back({case_index, assignment->attempt});
    return started;
  }

  /// Reports flown cases or, while there are none, begun ones.
  void Report() {
    std::vector<dispersa_idl_FlownCaseV3> messages;
    for (std::size_t i = 0; i < flown.size(); ++i) {
      Flown& each = flown[i];
      for (std::size_t k = 0; k < each.events.size(); ++k) each.events[k].name = View(each.names[k]);
      messages.push_back({assignment->cases[i], assignment->attempt, View(each.outcome), each.end_time_s,
                          each.end_stage, View(each.reason), View<dds_sequence_double>(each.inputs),
                          each.inputs_digest[0], each.inputs_digest[1],
                          View<dds_sequence_double>(each.metrics), each.digest[0], each.digest[1],
                          View<dds_sequence_dispersa_idl_SeenEventV1>(each.events)});
    }
    std::vector<dispersa_idl_StartedCaseV2> started = Started();
    dispersa_idl_ReportV3 report{};
    report.worker = View(name);
    report.coordinator_epoch = assignment->epoch;
    report.number = flown.empty() ? 0 : kReport;
    report.flight_id = View(flight_id);
    report.flown = View<dds_sequence_dispersa_idl_FlownCaseV3>(messages);
    report.started = View<dds_sequence_dispersa_idl_StartedCaseV2>(started);
    cyclone::Check(dds_write(reports, &report), "report");
    reported = dds_time();
  }

  void AskForText() {
    const dispersa_idl_TextRequestV1 request{View(name), View(flight_id), text.size()};
    cyclone::Check(dds_write(requests, &request), "text request");
    requested = dds_time();
  }

  /// Long work has a thread of its own: a worker without a message for 3 s counts as lost.
  void Begin() {
    flights = std::async(std::launch::async, [this, indices = assignment->cases] {
      std::vector<Flown> results;
      for (const std::uint64_t case_index : indices) results.push_back(Fly(dispersa, file, case_index));
      return results;
    });
    Report();
  }

  void Step() {
    cyclone::TakeAll<dispersa_idl_OrdersV1>(orders, [this](const dispersa_idl_OrdersV1& said) { On(said); });
    cyclone::TakeAll<dispersa_idl_TextV1>(texts, [this](const dispersa_idl_TextV1& part) { On(part); });
    const dds_time_t now = dds_time();
    if (assignment && !complete && now - requested > kRepetition) AskForText();
    if (assignment && complete && !Begun()) Begin();
    if (flights.valid() && flights.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      flown = flights.get();
      std::cout << "flown " << flown.size() << std::endl;
      Report();
    }
    if (!flown.empty() && now - reported > kRepetition) Report();
    if (now - said_status > kStatusPeriod) {
      said_status = now;
      // From the first case on: nothing more is begun, so no second assignment is wanted.
      SayStatus(Begun() ? dispersa_idl_WORKER_DRAINING_V2 : dispersa_idl_WORKER_READY_V2);
    }
  }

  static constexpr std::uint64_t kReport = 1;  ///< the number of the only report with results

  std::string name, host = "a host of Cyclone DDS", dispersa, file, engine_version;
  dds_entity_t participant, orders, texts, statuses, reports, requests;
  std::uint64_t epoch = 0;
  std::optional<Assignment> assignment;
  std::string flight_id, text;  ///< of the campaign, as far as it has come
  bool complete = false, stored = false;
  std::future<std::vector<Flown>> flights;
  std::vector<Flown> flown;
  dds_time_t said_status = 0, requested = 0, reported = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  Worker worker(std::atoi(argv[1]), argv[2], argv[3], argv[4]);
  while (!worker.stored) {
    worker.Step();
    dds_sleepfor(kRound);
  }
  std::cout << "stored" << std::endl;
  worker.assignment.reset();
  worker.SayStatus(dispersa_idl_WORKER_LEFT_V2);
  dds_wait_for_acks(worker.statuses, DDS_SECS(1));
  dds_delete(worker.participant);
  return 0;
}
