#include "services/worker/program.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/containment/contained.h"
#include "core/containment/foreign_process.h"
#include "core/flight/lane_engine.h"
#include "services/log/log.h"
#include "services/program/command_line.h"
#include "services/program/completion_words.h"
#include "services/program/exit_code.h"
#include "services/program/failure.h"
#include "services/program/option_values.h"
#include "services/program/standard_output.h"
#include "services/transport/admission.h"
#include "services/transport/run_pass.h"
#include "services/worker/worker.h"

namespace dispersa {

int RunWorker(int argc, char** argv) {
  PrepareFiles();
  LogForDaemon("dispersa-worker");

  WorkerOptions options;
  std::string peer = "127.0.0.1";
  Admission admission;
  CLI::App app(
      "Flies cases for a coordinator, and waits while there is none. At SIGTERM it finishes its cases in "
      "flight,\n"
      "returns the others and leaves; a second SIGTERM ends it at once.",
      "dispersa-worker");
  bool json = false;
  BeginCommandLine(app, json, "with --version, or for an error: print one JSON object");
  app.add_option("--domain", options.network.domain, "DDS domain")
      ->envname("DISPERSA_DOMAIN")
      ->transform(WholeNumber(0, 99));
  app.add_option("--peer", peer,
                 "HOST[:PORT] of the coordinator, several with commas between if another host may take over; "
                 "default: this machine");
  app.add_option("--address", options.network.address, "IPv4 address of the only network interface to use")
      ->check(CLI::ValidIPV4);
  app.add_option("--keys", admission.keys, kKeysHelp)->type_name(kFolderType);
  app.add_flag("--insecure", admission.insecure, kInsecureHelp);
  app.add_flag("--allow-plugins", admission.allow_plugins, kAllowPluginsHelp);
  app.add_option("--slots", options.slots, "threads that fly; default: 1")->transform(WholeNumber(1, 1024));
  app.add_option("--idle-exit", options.idle_exit_s,
                 "leave with exit code 0 after this number of seconds without a case; default: never")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--patience", options.patience_s,
                 "end with exit code 5 after this number of seconds without a coordinator; default: never")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--uuid", options.uuid, "name of this process; default: a random one");
  std::string log = "text";
  AddLogOption(app, log);
  std::optional<int> run_pass;
  app.add_option("--run-pass", run_pass, "descriptor from which `dispersa run` tells its worker who it is")
      ->group("");  // for it alone
  if (const auto code = ParseCommandLine(app, argc, argv)) return *code;
  if (log == "json") LogAsJson();
  try {
    ChosenEngine();
  } catch (const std::invalid_argument& error) {
    return EndFor(Failure{kExitBadInput, error.what()}, json);
  }

  // Before any thread starts, so that every thread leaves the signals to the one that waits for them.
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigaddset(&ends, SIGINT);
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);

  int code = kExitInternalError;
  try {
    if (log == "json") SendForeignOutputTo(OpenLoggedPipe());
    options.peers = ParsePeers(peer, options.network.domain);
    if (run_pass) {  // a worker of `dispersa run` has the secret of its run
      RunPass pass = TakeRunPass(*run_pass);
      options.network.secret = pass.secret;
      RefusePlugins("is not the shared object that the campaign of this run names", std::move(pass.plugins));
    } else {
      options.network = Admit(options.network, admission, {Role::kWorker}, FarthestHost(options.peers));
      AdmitPlugins(admission.allow_plugins);
    }
    options.uuid = NameOnNetwork(options.network, options.uuid.empty() ? MakeUuid() : options.uuid);
    Worker worker(options);
    std::thread([&] {
      int signal = 0;
      sigwait(&ends, &signal);
      worker.Drain();
      sigwait(&ends, &signal);
      // Ends by the signal itself, so that the parent process does not take it for a crash.
      std::signal(signal, SIG_DFL);
      pthread_sigmask(SIG_UNBLOCK, &ends, nullptr);
      std::raise(signal);
    }).detach();
    const WorkerExit exit = worker.Run();
    code = worker.problem().empty()
               ? kExitDone
               : EndFor(Failure{exit == WorkerExit::kFault ? kExitInternalError : kExitIncomplete,
                                worker.problem()},
                        json);
    std::_Exit(code);  // the other threads still use what a return would destroy
  } catch (const NetworkError& error) {
    code = EndFor(Failure{kExitBadInput, error.what()}, json);
  } catch (const std::exception& error) {
    code = EndFor(FailureOf(error), json);
  }
  return code;
}

}  // namespace dispersa
