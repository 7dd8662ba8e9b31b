// Time of a case on the network: loopback, a coordinator, and a worker that returns results at once.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "services/ledger/ledger.h"
#include "services/transport/admission.h"
#include "services/transport/authority.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/private_domain.h"
#include "services/transport/worker_link.h"

namespace dispersa {
namespace {

using std::chrono::milliseconds;

const std::string kFlightId(64, 'f');

double ProcessorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Answers each case as a real worker does: a start, and the result with the next start.
void Answer(WorkerLink& link, const std::string& worker, const std::atomic<bool>& stop) {
  Report report{.worker = worker,
                .coordinator_epoch = 1,
                .number = 0,
                .flight_id = kFlightId,
                .flown = {},
                .started = {}};
  CaseResult result;
  result.outcome = Outcome::kCompleted;
  result.inputs.assign(21, 1.0 / 3.0);
  result.metrics.assign(MetricCount(kUsualStages), 2.0 / 3.0);
  // A coordinator listens to nobody who has not introduced himself.
  WorkerStatus status;
  status.worker = worker;
  status.host = "host";
  status.pid = 1;
  status.engine_version = EngineVersion();
  while (!stop) {
    if (report.number == 0) link.Send(status);
    for (const WorkerEvent& event : link.Wait(milliseconds(20))) {
      const auto* orders = std::get_if<Orders>(&event);
      if (orders == nullptr) continue;
      for (const FlyOrder& order : orders->assignments) {
        for (const std::uint64_t case_index : order.cases) {
          report.started = {{case_index, order.attempt}};
          ++report.number;
          link.Send(report);
          result.case_index = case_index;
          report.flown = {{order.attempt, result}};
        }
        report.started.clear();
        ++report.number;
        link.Send(report);
        report.flown.clear();
      }
    }
  }
}

/// Keys of a coordinator and a worker, in a folder that goes with it.
class Keys {
 public:
  Keys() { MakeAuthority(folder_.path(), ValidFor(1)); }
  KeyFolder Of(Role role) {
    return OpenKeyFolder(IssueKeys(folder_.path(), role, "one", ValidFor(1)), {role});
  }

 private:
  TemporaryFolder folder_;
};

/// One assignment of state.range(0) cases, until its last result is back; with keys if state.range(1).
void BM_AssignmentRoundTrip(benchmark::State& state) {
  const PrivateDomain domain;
  NetworkOptions ours{domain.domain(), "127.0.0.1"}, theirs = ours;
  std::optional<Keys> keys;
  if (state.range(1) != 0) {
    keys.emplace();
    ours.keys = keys->Of(Role::kCoordinator);
    theirs.keys = keys->Of(Role::kWorker);
  }
  const std::string name = NameOnNetwork(theirs, "w");
  CoordinatorLink coordinator(ours);
  WorkerLink link(theirs, {{"127.0.0.1", CoordinatorPort(domain.domain())}}, name);
  std::atomic<bool> stop = false;
  std::jthread worker([&] { Answer(link, name, stop); });

  std::vector<std::uint64_t> cases(static_cast<std::size_t>(state.range(0)));
  std::iota(cases.begin(), cases.end(), 0);
  std::uint64_t attempt = 0;
  const auto round = [&] {
    Orders orders;
    orders.worker = name;
    orders.coordinator_epoch = 1;
    orders.assignments = {{kFlightId, ++attempt, cases}};
    // Repeated until they are answered, as a coordinator does: the first may go before anybody listens.
    std::set<std::uint64_t> flown;
    auto said = std::chrono::steady_clock::time_point();
    while (flown.size() < cases.size()) {
      if (const auto now = std::chrono::steady_clock::now(); now > said + milliseconds(1000)) {
        said = now;
        coordinator.Send(orders);
      }
      for (const CoordinatorEvent& event : coordinator.Wait(milliseconds(100))) {
        const auto* report = std::get_if<Report>(&event.what);
        if (report == nullptr) continue;
        for (const FlownCase& each : report->flown)
          if (each.attempt == attempt) flown.insert(each.result.case_index);
      }
    }
  };
  round();  // matched from here on
  const double before_s = ProcessorSeconds();
  for (auto _ : state) round();
  const auto flown = static_cast<double>(state.iterations()) * static_cast<double>(cases.size());
  state.counters["cases/s"] = benchmark::Counter(flown, benchmark::Counter::kIsRate);
  // Of both ends together.
  state.counters["cpu_us/case"] = 1e6 * (ProcessorSeconds() - before_s) / flown;
  stop = true;
}
BENCHMARK(BM_AssignmentRoundTrip)
    ->ArgNames({"cases", "keys"})
    ->ArgsProduct({{1, 8, 64}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// The ledger's share of a case.
void BM_LedgerCase(benchmark::State& state) {
  const std::uint64_t cases = 100'000;
  for (auto _ : state) {
    Ledger ledger("1", cases);
    for (const char* id : {"a", "b"}) ledger.Join(id, {"1", 1, 2}, 0.0);
    double now_s = 0.0;
    while (!ledger.Complete()) {
      for (const Assignment& assignment : ledger.Assign(now_s)) {
        for (const std::uint64_t case_index : assignment.cases) {
          ledger.Started(assignment.worker, case_index, assignment.attempt, now_s);
          now_s += 0.01;
          ledger.Finished(assignment.worker, case_index, assignment.attempt, {case_index, 0}, now_s);
        }
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cases));
}
BENCHMARK(BM_LedgerCase)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dispersa
