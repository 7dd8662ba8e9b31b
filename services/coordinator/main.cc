// dispersa-coordinator: serves a campaign to the workers that come.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "core/flight/engine_version.h"
#include "core/report/reports.h"
#include "services/coordinator/coordinator.h"
#include "services/coordinator/open_campaign.h"
#include "services/coordinator/stop_signal.h"

namespace dispersa {
namespace {

// The product's exit codes that no verdict gives.
constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kIncomplete = 5;
constexpr int kInterrupted = 130;

constexpr std::chrono::seconds kProgressPeriod(5);

constexpr double kSayAgain_s = 30.0;

struct Stopped {};
struct NobodyCame {};

/// Says when nobody flies, again and again; throws NobodyCame when that lasts longer than `patience_s`.
class Attendance {
 public:
  Attendance(int domain, std::optional<double> patience_s) : domain_(domain), patience_s_(patience_s) {}

  void Check(std::size_t workers, double now_s) {
    if (workers > 0) {
      present_s_ = said_s_ = now_s;
      return;
    }
    if (now_s - said_s_ >= kSayAgain_s) {
      said_s_ = now_s;
      spdlog::warn("no worker for {:.0f} s; they may come to port {}", now_s - present_s_,
                   CoordinatorPort(domain_));
    }
    if (patience_s_ && now_s - present_s_ > *patience_s_) throw NobodyCame();
  }

 private:
  int domain_;
  std::optional<double> patience_s_;
  double present_s_ = 0.0, said_s_ = 0.0;
};

int Serve(const NetworkOptions& network, const CampaignRequest& request, std::optional<double> patience_s) {
  OpenedCampaign opened = OpenCampaign(request);
  CampaignBook book(opened.campaign, std::move(opened.folder));
  Coordinator coordinator(network, book);
  spdlog::info("campaign {}, flight id {}, results in {}; domain {}, workers may come to port {}",
               book.campaign().name, book.campaign().flight_id, book.folder().directory().string(),
               network.domain, CoordinatorPort(network.domain));
  auto progress_due = std::chrono::steady_clock::now();
  Attendance attendance(network.domain, patience_s);
  while (!book.Complete() && !StopRequested()) {
    coordinator.Step(std::chrono::milliseconds(100));
    try {
      attendance.Check(coordinator.joined(), coordinator.now_s());
    } catch (const NobodyCame&) {
      book.Flush();
      spdlog::error("no worker for {:.0f} s: given up; the same with --resume goes on", *patience_s);
      return kIncomplete;
    }
    if (const auto now = std::chrono::steady_clock::now(); now >= progress_due) {
      progress_due = now + kProgressPeriod;
      const LedgerProgress progress = book.ledger().Progress();
      spdlog::info("{}/{} cases done, {} assigned, {} quarantined, {} workers", progress.done, progress.total,
                   progress.assigned, progress.quarantined, coordinator.joined());
    }
  }
  // First what would be lost. Workers are sent home by a campaign that is complete on the disk and by nothing
  // else: a coordinator that stops, or is killed here, finds them again when it is back.
  book.Flush();
  ReportOptions options;
  options.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  options.progress = [](const std::string&, std::uint64_t, std::uint64_t) {
    if (StopRequested()) throw Stopped();
  };
  std::optional<CampaignSummary> summary;
  try {
    if (StopRequested()) throw Stopped();
    coordinator.Dismiss();
    summary = WriteReports(book.folder(), book.campaign(), options);
  } catch (const Stopped&) {
    spdlog::warn("stopped; the same with --resume goes on");
    return kInterrupted;
  }
  fmt::print("result: {}\n", book.folder().directory().string());
  return book.ledger().Progress().conflicts > 0 ? kInternalError : VerdictExitCode(summary->verdict);
}

int Main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("dispersa-coordinator"));
  NetworkOptions network;
  CampaignRequest request;
  std::optional<double> patience_s;
  CLI::App app(
      "Serves one campaign to all dispersa-worker processes of a DDS domain, then writes its reports.",
      "dispersa-coordinator");
  app.set_version_flag("--version", EngineVersion());
  app.add_option("campaign", request.campaign, "campaign file")->required();
  app.add_option("--out", request.out, "result folder; default: results/<name>-<first 8 of id>");
  app.add_option("--cases", request.overrides.cases, "number of cases, instead of the file's")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", request.overrides.seed, "seed, instead of the file's");
  app.add_flag("--resume", request.resume, "go on in a folder of the same flight id");
  app.add_option("--domain", network.domain, "DDS domain")
      ->envname("DISPERSA_DOMAIN")
      ->check(CLI::Range(0, 99));
  app.add_option("--address", network.address, "IPv4 address of the only network interface to use")
      ->check(CLI::ValidIPV4);
  app.add_option("--patience", patience_s,
                 "give up (exit code 5) after so many seconds without a worker; default: never")
      ->check(CLI::NonNegativeNumber);
  app.footer(
      "Example: dispersa-coordinator campaigns/table3.yaml --out results/table3 --domain 7\n"
      "         dispersa-worker --domain 7 --peer coordinator-host");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  CatchStopSignals();
  try {
    return Serve(network, request, patience_s);
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const NetworkError& error) {
    spdlog::error("{}", error.what());
    return kBadInput;
  } catch (const ResultError& error) {
    spdlog::error("{}", error.what());
    return error.kind() == ResultError::Kind::kDiskFull ? kIncomplete : kInternalError;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return kInternalError;
  }
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) { return dispersa::Main(argc, argv); }
