// A connection to a coordinator, shared by all commands that ask one.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "services/program/exit_code.h"
#include "services/program/failure.h"
#include "services/transport/admission.h"
#include "services/transport/client_link.h"

namespace dispersa {

/// The coordinator's address and our keys.
struct SessionOptions {
  int domain = 0;
  std::string peer = "127.0.0.1";
  std::string address;
  Admission admission;
};

/// Asks a coordinator once, for a limited time. None: no answer.
using Call = std::function<std::optional<Reply>(const std::string& method, const std::string& arguments,
                                                const std::string& data, std::chrono::milliseconds patience)>;

/// One connection to a coordinator. Throws Failure, with the code and the words of the coordinator when it
/// refuses.
class Session {
 public:
  using Json = nlohmann::ordered_json;

  explicit Session(const SessionOptions& options);
  /// Over another connection than the network: of a program that has the coordinator in it.
  Session(Peer peer, bool has_keys, Call call);

  /// Asks for a limited time. None: no answer.
  std::optional<Reply> Try(const std::string& method, const Json& arguments, const std::string& data = "",
                           std::chrono::milliseconds patience = kPatience);
  /// The same, but throws Failure if there is no answer.
  Reply Ask(const std::string& method, const Json& arguments, const std::string& data = "");
  /// "no coordinator has answered at HOST:PORT for 15 s"
  std::string Silence(std::chrono::seconds silent = kPatience) const;

 private:
  static constexpr std::chrono::seconds kPatience{15};

  bool has_keys_;
  Peer peer_;
  Call call_;
};

}  // namespace dispersa
