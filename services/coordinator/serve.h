// The tasks of dispersa-coordinator. Each returns the exit code of a task that was done, and throws Failure,
// InputError, NetworkError or ResultError.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/coordinator/service.h"
#include "services/transport/network.h"
#include "services/web/web_server.h"

namespace dispersa {

struct ServeOptions {
  NetworkOptions network;
  /// share of the results that is flown again (empty: see Coordinator)
  std::optional<double> audit = {};
  std::vector<std::string>
      again;  ///< command that replaces this program when it receives no messages any more
};

struct ClientOptions {
  std::string data;                         ///< folder
  std::optional<HttpAddress> metrics = {};  ///< of the port for monitors
  std::optional<WebOptions> web = {};
  std::uint64_t max_cases = kDefaultMaxCases;
  Retention retention = {};
  Quotas quotas = {};
};

/// The campaigns that clients launch, until a signal to stop.
int ServeClients(const ServeOptions& options, const ClientOptions& clients);

/// Whether the coordinator of this domain answers on `host`.
int AskHealth(const NetworkOptions& network, const std::string& host);

/// Lets the coordinator of this domain on `host` end what flies, and waits until it has ended and, with a
/// name, its data folder is free. Interrupted it goes on.
int AskDrain(const NetworkOptions& network, const std::string& host, const std::string& data);

}  // namespace dispersa
