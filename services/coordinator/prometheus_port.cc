#include "services/coordinator/prometheus_port.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "services/http/http_server.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

// Scrapers come one at a time.
constexpr std::size_t kConnections = 32, kConnectionsOfPeer = 8;

}  // namespace

PrometheusPort::PrometheusPort(const HttpAddress& address) {
  HttpOptions options;
  options.address = address;
  options.limits.connections = kConnections;
  options.limits.connections_of_peer = kConnectionsOfPeer;
  try {
    server_ = std::make_unique<HttpServer>(options, [this](const HttpRequest& request) {
      HttpAnswer answer;
      if (request.method != "GET" || (request.path != "/" && request.path != "/metrics")) {
        answer.status = 404;
        return answer;
      }
      answer.type = "text/plain; version=0.0.4; charset=utf-8";
      const Lock lock(mutex_);
      answer.body = text_;
      return answer;
    });
  } catch (const std::runtime_error& error) {
    throw NetworkError(std::string("metrics: ") + error.what());
  }
}

PrometheusPort::~PrometheusPort() = default;

void PrometheusPort::Set(std::string text) {
  const Lock lock(mutex_);
  text_ = std::move(text);
}

}  // namespace dispersa
