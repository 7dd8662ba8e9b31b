#include "services/fleet_cli/session_options.h"

#include <utility>

#include "services/program/failure.h"
#include "services/program/option_values.h"

namespace dispersa {

void BindSession(CLI::App* command, Invocation& invocation,
                 std::function<ExitCode(Session&, const GlobalOptions&)> run) {
  const auto options = std::make_shared<SessionOptions>();
  command->add_option("--domain", options->domain, "DDS domain of the coordinator")
      ->envname("DISPERSA_DOMAIN")
      ->transform(WholeNumber(0, 99));
  command->add_option("--peer", options->peer, "HOST[:PORT] of the coordinator; default: this machine");
  command->add_option("--address", options->address, "IPv4 address of the only network interface to use")
      ->check(CLI::ValidIPV4);
  command->add_option("--keys", options->admission.keys, kKeysHelp)->type_name(kFolderType);
  command->add_flag("--insecure", options->admission.insecure, kInsecureHelp);
  command->callback([options, &invocation, run = std::move(run)] {
    invocation.command = [options, run](const GlobalOptions& global) {
      try {
        Session session(*options);
        return run(session, global);
      } catch (const Failure& failure) {
        return EndFor(InputError(failure.message), global.json, failure.code);
      }
    };
  });
}

std::shared_ptr<std::string> AddIdOption(CLI::App* command, bool required) {
  auto id = std::make_shared<std::string>();
  command->add_option("id", *id, "campaign id, or its first characters")->required(required);
  return id;
}

}  // namespace dispersa
