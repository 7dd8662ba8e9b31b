#include "services/cli/session.h"

#include <fmt/format.h>

#include <utility>

#include "services/program/error_json.h"

namespace dispersa {

Session::Session(const SessionOptions& options) : has_keys_(!options.admission.keys.empty()) {
  try {
    peer_ = ParsePeer(options.peer, options.domain);
    const NetworkOptions network = Admit({options.domain, options.address}, options.admission,
                                         {Role::kClient, Role::kCoordinator}, peer_.host);
    link_ = std::make_unique<ClientLink>(network, peer_);
  } catch (const NetworkError& error) {
    throw Failure{kExitBadInput, error.what()};
  }
}

std::optional<Reply> Session::Try(const std::string& method, const Json& arguments, const std::string& data,
                                  std::chrono::milliseconds patience) {
  auto reply = link_->Call(method, arguments.dump(), data, patience);
  if (reply && reply->code != 0) throw Failure{static_cast<ExitCode>(reply->code), reply->text};
  return reply;
}

Reply Session::Ask(const std::string& method, const Json& arguments, const std::string& data) {
  if (auto reply = Try(method, arguments, data)) return *std::move(reply);
  // Whoever has keys hears nobody without: it cannot tell us so.
  throw Failure{
      kExitIncomplete,
      Silence() + (has_keys_ ? "" : "; a coordinator with keys answers only clients with keys (--keys)")};
}

std::string Session::Silence(std::chrono::seconds silent) const {
  return fmt::format("no coordinator has answered at {}:{} for {} s", peer_.host, peer_.port, silent.count());
}

void BindSession(CLI::App* command, Invocation& invocation,
                 std::function<ExitCode(Session&, const GlobalOptions&)> run) {
  const auto options = std::make_shared<SessionOptions>();
  command->add_option("--domain", options->domain, "DDS domain of the coordinator")
      ->envname("DISPERSA_DOMAIN")
      ->check(CLI::Range(0, 99));
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
        fmt::print(stderr, "{}\n", failure.message);
        if (global.json) PrintErrorJson(failure.code, failure.message);
        return failure.code;
      }
    };
  });
}

std::shared_ptr<std::string> AddIdOption(CLI::App* command, bool required) {
  auto id = std::make_shared<std::string>();
  command->add_option("id", *id, "campaign: its id or how that begins")->required(required);
  return id;
}

}  // namespace dispersa
