#include "services/fleet/session.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace dispersa {

Session::Session(const SessionOptions& options) : has_keys_(!options.admission.keys.empty()) {
  try {
    peer_ = ParsePeer(options.peer, options.domain);
    const NetworkOptions network = Admit({options.domain, options.address}, options.admission,
                                         {Role::kClient, Role::kCoordinator}, peer_.host);
    call_ = [link = std::make_shared<ClientLink>(network, peer_)](
                const std::string& method, const std::string& arguments, const std::string& data,
                std::chrono::milliseconds patience) { return link->Call(method, arguments, data, patience); };
  } catch (const NetworkError& error) {
    throw Failure{kExitBadInput, error.what()};
  }
}

Session::Session(Peer peer, bool has_keys, Call call)
    : has_keys_(has_keys), peer_(std::move(peer)), call_(std::move(call)) {}

std::optional<Reply> Session::Try(const std::string& method, const Json& arguments, const std::string& data,
                                  std::chrono::milliseconds patience) {
  auto reply = call_(method, arguments.dump(), data, patience);
  if (reply && reply->code != 0) throw Failure{static_cast<ExitCode>(reply->code), reply->text};
  return reply;
}

Reply Session::Ask(const std::string& method, const Json& arguments, const std::string& data) {
  if (auto reply = Try(method, arguments, data)) return *std::move(reply);
  // A coordinator with keys does not receive our messages without keys, so it cannot refuse them.
  throw Failure{kExitIncomplete,
                Silence() + (has_keys_ ? ""
                                       : "; a coordinator with keys answers only clients with keys (--keys), "
                                         "one without keys only clients of its own user")};
}

std::string Session::Silence(std::chrono::seconds silent) const {
  return fmt::format("no coordinator has answered at {}:{} for {} s", peer_.host, peer_.port, silent.count());
}

}  // namespace dispersa
