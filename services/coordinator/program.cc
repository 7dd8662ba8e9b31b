#include "services/coordinator/program.h"

#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/containment/foreign_process.h"
#include "core/results/result_error.h"
#include "services/coordinator/serve.h"
#include "services/ledger/result_exit_code.h"
#include "services/log/log.h"
#include "services/program/command_line.h"
#include "services/program/completion_words.h"
#include "services/program/exit_code.h"
#include "services/program/failure.h"
#include "services/program/option_values.h"
#include "services/program/standard_output.h"
#include "services/program/stop_signal.h"
#include "services/transport/admission.h"

namespace dispersa {
namespace {

CLI::Validator IsHttpAddress() {
  return CLI::Validator(
      [](const std::string& text) {
        HttpAddress address;
        return ReadHttpAddress(text, &address)
                   ? ""
                   : "'" + text +
                         "' is no address, allowed: a port from 1 to 65535, or an IPv4 "
                         "address and a port as 0.0.0.0:9464";
      },
      "");
}

/// What the command line says.
struct CoordinatorOptions {
  ClientOptions clients;
  std::string metrics, web, web_token;
  bool behind_tls = false;
  std::string log = "text";
  std::vector<std::string> keep, quotas;
  bool health = false, drain = false;
  std::optional<double> audit;
  NetworkOptions network;
  Admission admission;
  bool json = false;
};

void AddWebOptions(CLI::App& app, CoordinatorOptions& options) {
  app.add_option(
         "--metrics", options.metrics,
         "PORT of 127.0.0.1, or ADDRESS:PORT (0.0.0.0: all interfaces), that serves figures in Prometheus' "
         "text\nformat and the probes /healthz and /readyz to everybody who reaches it")
      ->type_name("TEXT")
      ->check(IsHttpAddress());
  app.add_option("--web", options.web,
                 "PORT of 127.0.0.1, or ADDRESS:PORT, of web pages to read campaigns by; without a "
                 "token for the\nuser of the coordinator alone; beyond 127.0.0.1 they need --web-token and "
                 "--web-behind-tls")
      ->type_name("TEXT")
      ->check(IsHttpAddress());
  app.add_option("--web-token", options.web_token, "with --web: file whose first line readers have to know")
      ->type_name(kFileType);
  app.add_flag("--web-behind-tls", options.behind_tls,
               "with --web: a proxy that speaks TLS stands before it and sets X-Forwarded-Proto");
}

void AddLimits(CLI::App& app, CoordinatorOptions& options) {
  app.add_option("--max-cases", options.clients.max_cases,
                 "largest number of cases of a campaign, because each case takes memory; a "
                 "launch of more is refused\n(default: 5000000)")
      ->transform(WholeNumber(1, kMostCases));
  app.add_option("--keep", options.keep,
                 "90d deletes a campaign 90 days after its end; 200GB deletes the campaigns that "
                 "ended first\nwhile all of them take more; may be given twice; default: keep all")
      ->type_name("TEXT")
      ->check(CLI::Validator(
          [](const std::string& text) {
            Retention retention;
            return ReadRetention(text, &retention)
                       ? ""
                       : "'" + text + "' is no limit, allowed: days as 90d, or a size as 200GB";
          },
          ""));
  app.add_option(
         "--quota", options.quotas,
         "limits of each owner's campaigns, as cases=1000000,campaigns=20,places=4,disk=200GB: "
         "cases and\ncampaigns that have not ended, campaigns that fly at once, disk space; "
         "ann:cases=5000000,disk=none: those\nof one owner; may be given several times; default: none")
      ->type_name("TEXT")
      ->check(CLI::Validator([](const std::string& text) { return Quotas().Add(text); }, ""));
}

void AddFlightOptions(CLI::App& app, CoordinatorOptions& options) {
  app.add_flag(
      "--health", options.health,
      "ask the coordinator of the domain on this machine whether it answers: exit code 0 if it does");
  app.add_flag(
      "--drain", options.drain,
      "let the coordinator of the domain on this machine end what flies and begin nothing else, and wait "
      "until it has\nended; what waits in its queue stays stored for the next one");
  app.add_option(
         "--audit", options.audit,
         "share of the results, 0 to 1, that the coordinator flies again; a worker whose result "
         "differs is expelled, and\nall its results are flown again; 0: none; default: 0.01, and none "
         "if the control law is a plug-in")
      ->check(CLI::Range(0.0, 1.0));
}

void AddNetworkOptions(CLI::App& app, CoordinatorOptions& options) {
  app.add_option("--domain", options.network.domain, "DDS domain")
      ->envname("DISPERSA_DOMAIN")
      ->transform(WholeNumber(0, 99));
  app.add_option("--address", options.network.address, "IPv4 address of the only network interface to use")
      ->check(CLI::ValidIPV4);
  app.add_option("--keys", options.admission.keys, kKeysHelp)->type_name(kFolderType);
  app.add_flag("--insecure", options.admission.insecure, kInsecureHelp);
  app.add_flag("--allow-plugins", options.admission.allow_plugins, kAllowPluginsHelp);
}

/// The program's end, or none: `options` then has what the arguments say.
std::optional<ExitCode> ReadArguments(int argc, char** argv, CoordinatorOptions& options) {
  CLI::App app(
      "Flies the campaigns that clients launch on the dispersa-worker processes of a DDS domain, until it is "
      "stopped.",
      "dispersa-coordinator");
  BeginCommandLine(app, options.json, "with --version, or for an error: print one JSON object");
  app.add_option("--data", options.clients.data,
                 "folder for the launched campaigns, made if it does not exist")
      ->type_name(kFolderType);
  AddWebOptions(app, options);
  AddLimits(app, options);
  AddFlightOptions(app, options);
  AddNetworkOptions(app, options);
  AddLogOption(app, options.log);
  app.footer(
      "Example: dispersa-coordinator --data /var/lib/dispersa --domain 7 --keys coordinator-main\n"
      "         dispersa-worker --domain 7 --peer coordinator-host --keys worker-node1");
  return ParseCommandLine(app, argc, argv);
}

void CheckTask(const CoordinatorOptions& options) {
  // With --drain the folder is that of the coordinator that ends.
  if (options.drain ? options.health : options.health == !options.clients.data.empty())
    throw InputError("give one of --data, --health and --drain");
}

WebOptions WebOf(const CoordinatorOptions& options) {
  WebOptions web;
  ReadHttpAddress(options.web, &web.address);
  if (!options.web_token.empty()) web.token = ReadWebToken(options.web_token);
  web.behind_tls = options.behind_tls;
  if (const std::string problem = WhyTooOpen(web); !problem.empty()) throw InputError(problem);
  return web;
}

/// With what the validators of the options have accepted as text.
ClientOptions ClientsOf(const CoordinatorOptions& options) {
  ClientOptions clients = options.clients;
  for (const std::string& limit : options.keep) ReadRetention(limit, &clients.retention);
  if (!options.metrics.empty()) ReadHttpAddress(options.metrics, &clients.metrics.emplace());
  for (const std::string& limits : options.quotas) clients.quotas.Add(limits);
  if (!options.web.empty()) clients.web = WebOf(options);
  return clients;
}

int DoTask(const CoordinatorOptions& options, std::vector<std::string> command) {
  CheckTask(options);
  CatchStopSignals();
  if (options.health || options.drain) {
    const std::string host = options.network.address.empty() ? "127.0.0.1" : options.network.address;
    const NetworkOptions network =
        Admit(options.network, options.admission, {Role::kCoordinator, Role::kClient}, host);
    return options.health ? AskHealth(network, host) : AskDrain(network, host, options.clients.data);
  }
  const ClientOptions clients = ClientsOf(options);
  const NetworkOptions network = Admit(options.network, options.admission, {Role::kCoordinator});
  AdmitPlugins(options.admission.allow_plugins);
  umask(0077);  // what clients have launched is nobody else's on this machine
  return ServeClients({network, options.audit, std::move(command)}, clients);
}

}  // namespace

int RunCoordinator(int argc, char** argv) {
  PrepareFiles();
  LogForDaemon("dispersa-coordinator");
  CoordinatorOptions options;
  if (const auto code = ReadArguments(argc, argv, options)) return *code;
  const bool as_json = options.log == "json";
  if (as_json) LogAsJson();
  try {
    if (as_json) SendForeignOutputTo(OpenLoggedPipe());
    return DoTask(options, std::vector<std::string>(argv, argv + argc));
  } catch (const InputError& error) {
    return EndFor(error, options.json);
  } catch (const Failure& failure) {
    return EndFor(failure, options.json);
  } catch (const NetworkError& error) {
    return EndFor(Failure{kExitBadInput, error.what()}, options.json);
  } catch (const ResultError& error) {
    return EndFor(Failure{ExitCodeOf(error), error.what()}, options.json);
  } catch (const std::exception& error) {
    return EndFor(FailureOf(error), options.json);
  }
}

}  // namespace dispersa
