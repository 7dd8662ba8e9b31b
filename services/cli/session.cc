#include "services/cli/session.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace dispersa {
namespace {

constexpr std::chrono::seconds kPatience(15);

}  // namespace

Session::Session(const SessionOptions& options) {
  try {
    peer_ = ParsePeer(options.peer, options.domain);
    link_ = std::make_unique<ClientLink>(NetworkOptions{options.domain, options.address}, peer_);
  } catch (const NetworkError& error) {
    throw Failure{kExitBadInput, error.what()};
  }
}

std::optional<Reply> Session::Try(const std::string& method, const Json& arguments, const std::string& data) {
  auto reply = link_->Call(method, arguments.dump(), data, kPatience);
  if (reply && reply->code != 0) throw Failure{static_cast<ExitCode>(reply->code), reply->text};
  return reply;
}

Reply Session::Ask(const std::string& method, const Json& arguments, const std::string& data) {
  if (auto reply = Try(method, arguments, data)) return *std::move(reply);
  throw Failure{kExitIncomplete, Silence()};
}

std::string Session::Silence() const {
  return fmt::format("no coordinator has answered at {}:{} for {} s", peer_.host, peer_.port,
                     kPatience.count());
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
  command->callback([options, &invocation, run = std::move(run)] {
    invocation.command = [options, run](const GlobalOptions& global) {
      try {
        Session session(*options);
        return run(session, global);
      } catch (const Failure& failure) {
        fmt::print(stderr, "{}\n", failure.message);
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
