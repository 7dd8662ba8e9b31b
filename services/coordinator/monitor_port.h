// An HTTP port for monitors: Prometheus' figures, and probes.
#pragma once

#include <memory>
#include <string>

#include "services/coordinator/health.h"
#include "services/http/http_address.h"
#include "services/program/mutex.h"

namespace dispersa {

class HttpServer;

/// Answers GET of
///
///   / and /metrics  with the last figures set
///   /healthz        200 "ok", or 503 with the reason why this coordinator is dead
///   /readyz         200 "ok", or 503 with the reason why it takes no campaigns
///
/// Throws NetworkError if the port is taken, or the address is none of this machine.
class MonitorPort {
 public:
  /// `health` outlives this port.
  MonitorPort(const HttpAddress& address, const Health& health);
  ~MonitorPort();
  MonitorPort(const MonitorPort&) = delete;
  MonitorPort& operator=(const MonitorPort&) = delete;

  /// In Prometheus' text format.
  void SetFigures(std::string text);

 private:
  Mutex mutex_;
  std::string figures_ DISPERSA_GUARDED_BY(mutex_);
  std::unique_ptr<HttpServer> server_;  // ends before what it reads
};

}  // namespace dispersa
