#include "services/coordinator/monitor_port.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "services/http/http_server.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

// Scrapers come one at a time.
constexpr std::size_t kConnections = 32, kConnectionsOfPeer = 8;

/// For a probe: `problem` is empty if all is well.
HttpAnswer Probed(const std::string& problem) {
  HttpAnswer answer;
  answer.status = problem.empty() ? 200 : 503;
  answer.type = "text/plain; charset=utf-8";
  answer.body = (problem.empty() ? "ok" : problem) + "\n";
  return answer;
}

}  // namespace

MonitorPort::MonitorPort(const HttpAddress& address, const Health& health) {
  HttpOptions options;
  options.address = address;
  options.limits.connections = kConnections;
  options.limits.connections_of_peer = kConnectionsOfPeer;
  options.headers = {{"Cache-Control", "no-store"}};
  try {
    server_ = std::make_unique<HttpServer>(options, [this, &health](const HttpRequest& request) {
      HttpAnswer answer;
      answer.status = 404;
      if (request.method != "GET") return answer;
      if (request.path == "/healthz") return Probed(health.WhyDead());
      if (request.path == "/readyz") return Probed(health.WhyNotReady());
      if (request.path != "/" && request.path != "/metrics") return answer;
      const Lock lock(mutex_);
      if (figures_.empty()) return Probed("it has no figures yet");
      answer.status = 200;
      answer.type = "text/plain; version=0.0.4; charset=utf-8";
      answer.body = figures_;
      return answer;
    });
  } catch (const std::runtime_error& error) {
    throw NetworkError(std::string("metrics: ") + error.what());
  }
}

MonitorPort::~MonitorPort() = default;

void MonitorPort::SetFigures(std::string text) {
  const Lock lock(mutex_);
  figures_ = std::move(text);
}

}  // namespace dispersa
