// A client's end of the network: it asks the coordinator and gets answers.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "services/transport/messages.h"
#include "services/transport/network.h"

namespace dispersa {

/// One thread. Throws NetworkError.
class ClientLink {
 public:
  ClientLink(const NetworkOptions& network, const Peer& coordinator);
  ~ClientLink();

  /// Asks until the answer comes, at most `patience`; empty if none comes. A request may be served several
  /// times.
  std::optional<Reply> Call(const std::string& method, const std::string& arguments, const std::string& data,
                            std::chrono::milliseconds patience);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
