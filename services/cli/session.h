// What the commands that speak to a coordinator share.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "services/cli/command.h"
#include "services/transport/admission.h"
#include "services/transport/client_link.h"

namespace dispersa {

/// Where the coordinator is.
struct SessionOptions {
  int domain = 0;
  std::string peer = "127.0.0.1";
  std::string address;
  Admission admission;
};

/// What ends a command.
struct Failure {
  ExitCode code;
  std::string message;
};

/// One connection to a coordinator. Throws Failure, with the code and the words of the coordinator when it
/// refuses.
class Session {
 public:
  using Json = nlohmann::ordered_json;

  explicit Session(const SessionOptions& options);

  /// Asks for so long. None: nobody has answered.
  std::optional<Reply> Try(const std::string& method, const Json& arguments, const std::string& data = "",
                           std::chrono::milliseconds patience = kPatience);
  /// The same; nobody is a Failure.
  Reply Ask(const std::string& method, const Json& arguments, const std::string& data = "");
  /// "no coordinator has answered at HOST:PORT for 15 s"
  std::string Silence(std::chrono::seconds silent = kPatience) const;

 private:
  static constexpr std::chrono::seconds kPatience{15};

  bool has_keys_;
  Peer peer_;
  std::unique_ptr<ClientLink> link_;
};

/// Adds the options of a session to a command, and `run` as what it does.
void BindSession(CLI::App* command, Invocation& invocation,
                 std::function<ExitCode(Session&, const GlobalOptions&)> run);

/// The option that names a campaign: its id or how that begins.
std::shared_ptr<std::string> AddIdOption(CLI::App* command, bool required = true);

}  // namespace dispersa
