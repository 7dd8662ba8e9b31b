#include "services/coordinator/serve.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/containment/foreign_process.h"
#include "core/input/input_error.h"
#include "core/results/folder_lock.h"
#include "services/coordinator/attendance.h"
#include "services/coordinator/catalogue.h"
#include "services/coordinator/coordinator.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/front_desk.h"
#include "services/coordinator/health.h"
#include "services/coordinator/monitor_port.h"
#include "services/coordinator/packed_files.h"
#include "services/coordinator/prometheus_text.h"
#include "services/coordinator/service.h"
#include "services/coordinator/watchdog.h"
#include "services/coordinator/web_rows.h"
#include "services/log/log.h"
#include "services/program/exit_code.h"
#include "services/program/failure.h"
#include "services/program/stop_signal.h"
#include "services/program/threads.h"
#include "services/transport/client_link.h"

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kRound(50);
constexpr double kFigures_s = 1.0;
constexpr double kHealth_s = 0.5;
constexpr double kWeb_s = 1.0;
constexpr double kWebPause_s = 0.2;
constexpr double kLogCounts_s = 1.0;
constexpr int kMostReports = 8;  // at once: each takes memory of its campaign
constexpr std::chrono::seconds kHealthPatience(8);
constexpr double kFarewell_s = 2.0;  // until the answer to the last request has arrived
constexpr std::chrono::seconds kDrainPeriod(1), kDrainPatience(2);
constexpr std::chrono::seconds kSilence(30);  ///< of a coordinator that has not ended: it hangs

/// From the signal to the end, whatever still reads, parses or reports: the disk has all that is promised.
constexpr std::chrono::milliseconds kLongestEnd(3500);
constexpr std::chrono::milliseconds kLook(100);

constexpr double kFade = 0.9;  // each second: a monitor that looks every 15 s still sees a long round

class Stopwatch {
 public:
  double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

 private:
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

/// True now and then.
class Every {
 public:
  explicit Every(double period_s) : period_s_(period_s) {}
  bool IsDue(double now_s) {
    if (now_s < due_s_) return false;
    due_s_ = now_s + period_s_;
    return true;
  }

 private:
  double period_s_;
  double due_s_ = 0.0;
};

/// Ends this program in time, though what it began takes minutes. The next coordinator begins it anew.
void EndInTime(const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> asked;
  for (; !stop.stop_requested(); std::this_thread::sleep_for(kLook)) {
    if (!StopRequested()) continue;
    if (!asked) asked = Clock::now();
    if (Clock::now() - *asked < kLongestEnd) continue;
    LogWarning("what goes on is not waited for; the next coordinator begins it again");
    std::_Exit(kExitDone);
  }
}

/// Without keys the coordinator hears its own user alone, or everybody (--insecure). Empty: with keys.
std::string EverybodyOn(const NetworkOptions& network) {
  if (network.keys) return "";
  if (!network.secret) return "anybody";
  const passwd* user = getpwuid(geteuid());
  return user != nullptr ? user->pw_name : std::to_string(geteuid());
}

/// Files of campaigns, for threads that have no service. A campaign may be deleted while they read.
CampaignFile FilesBelow(const std::filesystem::path& data) {
  return [data](const std::string& id, const std::string& name) -> std::optional<std::string> {
    try {
      const auto file = name == "campaign.yaml" ? data / id / name : data / id / "results" / name;
      return ReadPart(file, 0, SizeOf(file));
    } catch (const std::exception&) {
      return std::nullopt;
    }
  };
}

std::string WhyPaused(const Service& service, const std::filesystem::path& data) {
  if (service.is_draining()) return "it is drained, and takes no campaign";
  for (const std::string& reason : {service.WhyPaused(), WhyDiskIsFull(data), WhyDescriptorsAreShort()})
    if (!reason.empty()) return reason;
  return "";
}

WebPages PagesOf(const ClientOptions& clients) {
  if (!clients.web) return {};
  const auto& [host, port] = clients.web->address;
  return {fmt::format("{}:{}", host, port), clients.web->behind_tls};
}

}  // namespace

// Workers stay when it ends: another coordinator on the same data takes them over.
int ServeClients(const ServeOptions& options, const ClientOptions& clients) {
  MakeDataFolder(clients.data);
  const std::uint64_t epoch = NextEpoch(clients.data, IsStartedByItself());
  const std::jthread end_in_time(EndInTime);
  // Before all that takes time, and until all of it has ended.
  Health health;
  std::optional<MonitorPort> monitors;
  if (clients.metrics) monitors.emplace(*clients.metrics, health);
  Coordinator coordinator(options.network, options.audit, epoch);
  ServiceOptions service_options;
  service_options.data = clients.data;
  service_options.max_cases = clients.max_cases;
  service_options.retention = clients.retention;
  service_options.quotas = clients.quotas;
  service_options.epoch = epoch;
  service_options.reports_at_once = static_cast<std::size_t>(std::clamp(UsableCores(), 2, kMostReports));
  service_options.report_threads = std::max(1, UsableCores() / 2);
  Service service(service_options, coordinator);
  FrontDesk front_desk(service, coordinator, EverybodyOn(options.network), PagesOf(clients),
                       options.network.keys ? options.network.keys->name : "");
  ServingTimes times;
  coordinator.Serve([&](const Request& request) {
    const Stopwatch watch;
    Reply reply = front_desk.Answer(request);
    ++times.requests;
    times.requests_s += watch.elapsed_s();
    return reply;
  });
  LogInfo("domain {}, workers and clients can join at port {}", options.network.domain,
          CoordinatorPort(options.network.domain));
  std::optional<WebServer> web;
  WebRows web_rows;
  if (clients.web) web.emplace(*clients.web, FilesBelow(clients.data));
  std::uint64_t shown_changes = 0;
  Every web_period(kWeb_s), web_pause(kWebPause_s), figures_period(kFigures_s), counts_period(kLogCounts_s),
      health_period(kHealth_s);
  Attendance attendance(options.network.domain);
  std::optional<Watchdog> watchdog(std::in_place, options.again, coordinator.StartPulse(), health);
  double drained_s = 0.0;  // since when
  while (!StopRequested() && (drained_s == 0.0 || coordinator.now_s() - drained_s < kFarewell_s)) {
    const Stopwatch round;
    coordinator.Step(kRound);
    service.Step();
    if (!service.IsDrained()) drained_s = 0.0;
    if (service.IsDrained() && drained_s == 0.0) drained_s = coordinator.now_s();
    watchdog->Note(coordinator.ReceivesReports(), service.HasWorkToFly());
    if (health_period.IsDue(coordinator.now_s())) health.SetPause(WhyPaused(service, clients.data));
    attendance.Check(coordinator.joined() > 0 || !service.HasWork(), coordinator.now_s());
    // Whoever has launched a campaign opens its page at once.
    const bool is_new =
        shown_changes != service.catalogue().changes() && web_pause.IsDue(coordinator.now_s());
    if (web && (web_period.IsDue(coordinator.now_s()) || is_new)) {
      web->Set(web_rows.Make(service, coordinator));
      shown_changes = service.catalogue().changes();
    }
    if (counts_period.IsDue(coordinator.now_s())) LogCounts();
    if (monitors && figures_period.IsDue(coordinator.now_s())) {
      monitors->SetFigures(PrometheusText(service, coordinator, times));
      times.longest_round_s *= kFade;
    }
    times.longest_round_s = std::max(times.longest_round_s, round.elapsed_s());
  }
  health.SetPause("it shuts down");
  watchdog.reset();
  EndForeignProcesses();  // a slow control law keeps nobody
  service.Flush();
  LogInfo("stopped; campaigns that have not ended continue when the coordinator starts again");
  return 0;
}

namespace {

Failure DoesNotAnswer(const NetworkOptions& network) {
  return {kExitIncomplete, fmt::format("the coordinator of domain {} does not answer", network.domain)};
}

/// A coordinator has ended when another process can have its folder.
bool HasEnded(const std::string& data) {
  try {
    const FolderLock lock(data);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

int AskHealth(const NetworkOptions& network, const std::string& host) {
  ClientLink client(network, {host, CoordinatorPort(network.domain)});
  const auto reply = client.Call("health", "{}", "", kHealthPatience);
  if (reply && reply->code == 0) return 0;
  throw DoesNotAnswer(network);
}

int AskDrain(const NetworkOptions& network, const std::string& host, const std::string& data) {
  ClientLink client(network, {host, CoordinatorPort(network.domain)});
  std::string said;
  nlohmann::json epoch;
  for (auto answered = std::chrono::steady_clock::now();;) {
    if (StopRequested()) throw Failure{kExitInterrupted, "interrupted; the coordinator goes on draining"};
    const nlohmann::json arguments =
        epoch.is_null() ? nlohmann::json::object() : nlohmann::json{{"epoch", epoch}};
    // Who knows the folder asks it whether the coordinator has ended.
    const auto patience = epoch.is_null() || data.empty() ? kHealthPatience : kDrainPatience;
    const auto reply = client.Call("drain", arguments.dump(), "", patience);
    if (!reply && epoch.is_null()) throw DoesNotAnswer(network);
    if (!reply) {
      if (data.empty() || HasEnded(data)) break;
      // It may write its reports, or end.
      if (std::chrono::steady_clock::now() - answered < kSilence) continue;
      throw Failure{kExitIncomplete, data + ": the coordinator does not answer any more, but has not ended"};
    }
    answered = std::chrono::steady_clock::now();
    if (reply->code != 0) throw Failure{static_cast<ExitCode>(reply->code), reply->text};
    const auto answer = nlohmann::json::parse(reply->text);
    if (!epoch.is_null() && answer.at("epoch") != epoch) break;  // its successor
    epoch = answer.at("epoch");
    const std::string now =
        fmt::format("{} campaigns fly or get their reports, {} wait for the next coordinator",
                    answer.at("busy").get<std::uint64_t>(), answer.at("waiting").get<std::uint64_t>());
    if (now != said) LogInfo("draining: {}", now);
    said = now;
    std::this_thread::sleep_for(kDrainPeriod);
  }
  LogInfo("drained: the coordinator has ended");
  return 0;
}

}  // namespace dispersa
