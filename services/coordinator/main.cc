// dispersa-coordinator: serves the campaigns of clients, or one campaign, to the workers that come.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <optional>

#include "core/flight/engine_version.h"
#include "core/report/result_error.h"
#include "services/coordinator/serve.h"
#include "services/coordinator/stop_signal.h"

namespace dispersa {
namespace {

// The product's exit codes that no verdict gives.
constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kIncomplete = 5;

int Main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("dispersa-coordinator"));
  NetworkOptions network;
  CampaignRequest request;
  std::optional<double> patience_s;
  CLI::App app(
      "With --data: serves the campaigns that clients launch to all dispersa-worker processes of a DDS "
      "domain, until it is\n"
      "told to stop. With a campaign: serves that one, writes its reports and ends.",
      "dispersa-coordinator");
  app.set_version_flag("--version", EngineVersion());
  std::string data;
  bool health = false;
  std::optional<std::uint16_t> metrics_port;
  app.add_option("campaign", request.campaign, "campaign file");
  app.add_option("--data", data, "folder of the campaigns that were launched, made if it is not there");
  app.add_option("--metrics", metrics_port,
                 "with --data: port of 127.0.0.1 for metrics in Prometheus' text format")
      ->check(CLI::Range(1, 65535));
  app.add_flag("--health", health,
               "ask the coordinator of the domain on this machine: exit code 0 if it answers");
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
      "Example: dispersa-coordinator --data /var/lib/dispersa --domain 7\n"
      "         dispersa-coordinator campaigns/table3.yaml --out results/table3 --domain 7\n"
      "         dispersa-worker --domain 7 --peer coordinator-host");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  if (int(health) + int(!data.empty()) + int(!request.campaign.empty()) != 1) {
    fmt::print(stderr, "one of --data, a campaign, or --health is needed\n");
    return kBadInput;
  }
  CatchStopSignals();
  try {
    if (health) return AskHealth(network);
    if (!data.empty()) return ServeClients(network, data, metrics_port);
    return ServeCampaign(network, request, patience_s);
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
