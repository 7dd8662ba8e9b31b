#include "services/client/session.h"

#include <fmt/format.h>

#include <utility>


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

}  // namespace dispersa
