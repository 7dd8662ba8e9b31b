#include "services/coordinator/program.h"

#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign_yaml/standard_input.h"
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

}  // namespace

int RunCoordinator(int argc, char** argv) {
  PrepareFiles();
  LogForDaemon("dispersa-coordinator");
  NetworkOptions network;
  RunRequest request;
  std::optional<double> patience_s;
  Admission admission;
  CLI::App app(
      "With --data: flies the campaigns that clients launch on the dispersa-worker processes of a DDS "
      "domain,\n"
      "until it is stopped. With a campaign: flies this campaign, writes its reports and ends.",
      "dispersa-coordinator");
  bool json = false;
  BeginCommandLine(app, json, "with --version, or for an error: print one JSON object");
  ClientOptions clients;
  std::string& data = clients.data;
  bool health = false;
  std::optional<double> audit;
  std::vector<std::string> keep, quotas;
  app.add_option("campaign", request.campaign.name, "campaign file")->type_name(kFileType);
  app.add_option("--data", data, "folder for the launched campaigns, made if it does not exist")
      ->type_name(kFolderType);
  std::string metrics;
  app.add_option(
         "--metrics", metrics,
         "with --data: PORT of 127.0.0.1, or ADDRESS:PORT (0.0.0.0: all interfaces), that serves figures "
         "in\nPrometheus' text format to everybody who reaches it")
      ->type_name("TEXT")
      ->check(IsHttpAddress());
  std::string web, web_token;
  bool behind_tls = false;
  app.add_option(
         "--web", web,
         "with --data: PORT of 127.0.0.1, or ADDRESS:PORT, of web pages to read campaigns by; without a "
         "token for the\nuser of the coordinator alone; beyond 127.0.0.1 they need --web-token and "
         "--web-behind-tls")
      ->type_name("TEXT")
      ->check(IsHttpAddress());
  app.add_option("--web-token", web_token, "with --web: file whose first line readers have to know")
      ->type_name(kFileType);
  app.add_flag("--web-behind-tls", behind_tls,
               "with --web: a proxy that speaks TLS stands before it and sets X-Forwarded-Proto");
  app.add_option("--max-cases", clients.max_cases,
                 "with --data: largest number of cases of a campaign, because each case takes memory; a "
                 "launch of more is refused\n(default: 5000000)")
      ->transform(WholeNumber(1, kMostCases));
  app.add_option(
         "--keep", keep,
         "with --data: 90d deletes a campaign 90 days after its end; 200GB deletes the campaigns that "
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
         "--quota", quotas,
         "with --data: limits of each owner's campaigns, as cases=1000000,campaigns=20,places=4,disk=200GB: "
         "cases and\ncampaigns that have not ended, campaigns that fly at once, disk space; "
         "ann:cases=5000000,disk=none: those\nof one owner; may be given several times; default: none")
      ->type_name("TEXT")
      ->check(CLI::Validator([](const std::string& text) { return Quotas().Add(text); }, ""));
  app.add_flag(
      "--health", health,
      "ask the coordinator of the domain on this machine whether it answers: exit code 0 if it does");
  app.add_option(
         "--audit", audit,
         "share of the results, 0 to 1, that the coordinator flies again; a worker whose result "
         "differs is expelled, and\nall its results are flown again; 0: none; default: 0.01, and none "
         "if the control law is a plug-in")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--out", request.out, "result folder; default: results/<name>-<first 8 of id>")
      ->type_name(kFolderType);
  app.add_option("--cases", request.overrides.cases, "number of cases, instead of the file's")
      ->transform(WholeNumber(1, kMostCases));
  app.add_option("--seed", request.overrides.seed, "seed, instead of the file's");
  app.add_flag("--resume", request.resume, "continue in a result folder of the same flight id");
  app.add_option("--domain", network.domain, "DDS domain")
      ->envname("DISPERSA_DOMAIN")
      ->transform(WholeNumber(0, 99));
  app.add_option("--address", network.address, "IPv4 address of the only network interface to use")
      ->check(CLI::ValidIPV4);
  app.add_option("--keys", admission.keys, kKeysHelp)->type_name(kFolderType);
  app.add_flag("--insecure", admission.insecure, kInsecureHelp);
  app.add_flag("--allow-plugins", admission.allow_plugins, kAllowPluginsHelp);
  app.add_option("--patience", patience_s,
                 "end with exit code 5 after this number of seconds without a worker; default: never")
      ->check(CLI::NonNegativeNumber);
  app.footer(
      "Example: dispersa-coordinator --data /var/lib/dispersa --domain 7 --keys coordinator-main\n"
      "         dispersa-worker --domain 7 --peer coordinator-host --keys worker-node1\n"
      "         dispersa-coordinator campaigns/table3.yaml --out results/table3 --address 127.0.0.1");
  if (const auto code = ParseCommandLine(app, argc, argv)) return *code;
  if (int(health) + int(!data.empty()) + int(!request.campaign.name.empty()) != 1) {
    return EndFor(InputError("give one of --data, a campaign file, or --health"), json);
  }
  if (request.campaign.name == kStandardInput) {
    return EndFor(InputError("the campaign cannot come from standard input: a coordinator may restart itself "
                             "and read it again",
                             "a campaign file"),
                  json);
  }
  for (const std::string& limit : keep) ReadRetention(limit, &clients.retention);
  if (!metrics.empty()) ReadHttpAddress(metrics, &clients.prometheus.emplace());
  for (const std::string& limits : quotas) clients.quotas.Add(limits);
  CatchStopSignals();
  try {
    if (health) {
      const std::string host = network.address.empty() ? "127.0.0.1" : network.address;
      return AskHealth(Admit(network, admission, {Role::kCoordinator, Role::kClient}, host), host);
    }
    if (!web.empty()) {
      WebOptions& options = clients.web.emplace();
      ReadHttpAddress(web, &options.address);
      if (!web_token.empty()) options.token = ReadWebToken(web_token);
      options.behind_tls = behind_tls;
      if (const std::string problem = WhyTooOpen(options); !problem.empty()) throw InputError(problem);
    }
    network = Admit(network, admission, {Role::kCoordinator});
    AdmitPlugins(admission.allow_plugins);
    std::vector<std::string> again(argv, argv + argc);
    if (data.empty() && !request.resume) again.emplace_back("--resume");
    const ServeOptions options{network, audit, std::move(again)};
    if (!data.empty()) {
      umask(0077);  // what clients have launched is nobody else's on this machine
      return ServeClients(options, clients);
    }
    return EndOutput(ServeCampaign(options, request, patience_s));
  } catch (const InputError& error) {
    return EndFor(error, json);
  } catch (const Failure& failure) {
    return EndFor(failure, json);
  } catch (const NetworkError& error) {
    return EndFor(Failure{kExitBadInput, error.what()}, json);
  } catch (const ResultError& error) {
    return EndFor(Failure{ExitCodeOf(error), error.what()}, json);
  } catch (const std::exception& error) {
    return EndFor(FailureOf(error), json);
  }
}

}  // namespace dispersa
