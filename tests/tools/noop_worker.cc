// A worker that speaks as dispersa-worker does and flies nothing: made-up results, at once. What the service
// itself costs is measured with it, and that made-up results are found out.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/log/log.h"
#include "services/transport/admission.h"
#include "services/transport/worker_link.h"
#include "services/worker/flight_desk.h"

namespace dispersa {
namespace {

/// The same for every worker, another one for each case.
CaseResult MadeUp(std::uint64_t case_index, const CaseDesign& design, const RowInputs& rows) {
  CaseResult result;
  result.case_index = case_index;
  result.outcome = Outcome::kCompleted;
  result.end_time_s = 500.0;
  result.end_stage = 4;
  SetInputs(rows, InputValues(design.Draw(case_index)), result);  // the one thing that is seen at once
  result.metrics.assign(MetricCount(kUsualStages), 1.0 / static_cast<double>(case_index + 1));
  result.digest = {case_index, ~case_index};
  return result;
}

/// Until it is told to leave.
void Work(const NetworkOptions& network, const std::vector<Peer>& peers, std::uint32_t slots,
          double flight_s) {
  const auto start = std::chrono::steady_clock::now();
  const auto now_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const std::string uuid = NameOnNetwork(network, MakeUuid());
  FlightDesk desk({.worker = uuid, .engine_version = EngineVersion(), .slots = slots}, 0.0);
  std::optional<CaseDesign> design;
  RowInputs rows;  // of its one campaign
  std::optional<Job> flying;
  const std::chrono::milliseconds pause(flight_s > 0.0 ? 1 : 20);
  std::optional<WorkerLink> link(std::in_place, network, peers, uuid);
  while (!desk.left() && desk.refusal().empty()) {
    for (const WorkerEvent& event : link->Wait(pause)) {
      if (const auto* orders = std::get_if<Orders>(&event)) {
        desk.On(*orders, now_s());
      } else {
        desk.On(std::get<TextPart>(event), now_s());
      }
    }
    if (const auto text = desk.TakeText()) {
      const Campaign campaign = ParseCampaign(text->text, text->name);
      design.emplace(campaign);
      rows = RowInputs(campaign);
      desk.Loaded(text->flight_id, nullptr, "");
    }
    while (flying || (flying = desk.Next(now_s()))) {
      for (const Report& report : desk.TakeReports(now_s())) link->Send(report);
      if (now_s() < flying->started_s + flight_s) break;
      desk.Done(*flying, MadeUp(flying->case_index, *design, rows), now_s());
      flying.reset();
    }
    const FlightDesk::Due due = desk.Tick(now_s());
    if (due.status) {
      WorkerStatus status = *due.status;
      const char* const host = std::getenv("DISPERSA_NOOP_HOST");
      status.host = host == nullptr ? "nowhere" : host;
      link->Send(status);
    }
    for (const Report& report : due.reports) link->Send(report);
    for (const TextRequest& request : due.text_requests) link->Send(request);
    if (due.new_connection) link.emplace(network, peers, uuid);
  }
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) {
  using namespace dispersa;
  NetworkOptions network;
  std::string peer = "127.0.0.1";
  std::uint32_t slots = 1;
  Admission admission;
  CLI::App app("A worker that makes its results up.", "noop_worker");
  app.add_option("--domain", network.domain);
  app.add_option("--peer", peer);
  app.add_option("--address", network.address);
  app.add_option("--slots", slots);
  app.add_option("--keys", admission.keys);
  double flight_ms = 0.0;
  app.add_option("--flight-ms", flight_ms, "pretends that a flight takes so long; default: none");
  CLI11_PARSE(app, argc, argv);
  try {
    const std::vector<Peer> peers = ParsePeers(peer, network.domain);
    Work(Admit(network, admission, {Role::kWorker}, FarthestHost(peers)), peers, slots, 1e-3 * flight_ms);
  } catch (const NetworkError& error) {
    LogError("{}", error.what());
    return 2;
  }
  return 0;
}
