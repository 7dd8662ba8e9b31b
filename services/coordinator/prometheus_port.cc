#include "services/coordinator/prometheus_port.h"

#include <httplib.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "services/transport/network.h"

namespace dispersa {
namespace {

// Scrapers come one at a time; one that stops reading must not keep the next one out.
constexpr std::size_t kThreads = 2;
constexpr int kPatience_s = 1;
constexpr std::size_t kMaxBody = 1024;

}  // namespace

struct PrometheusPort::Serving {
  httplib::Server server;
  std::thread thread;
};

PrometheusPort::PrometheusPort(const HttpAddress& address) : serving_(std::make_unique<Serving>()) {
  httplib::Server& server = serving_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // By default httplib shares its port with whoever asks for it.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_keep_alive_max_count(1);
  server.set_keep_alive_timeout(kPatience_s);  // for the first request too
  server.set_read_timeout(kPatience_s);
  server.set_write_timeout(kPatience_s);
  server.set_payload_max_length(kMaxBody);
  const auto answer = [this](const httplib::Request&, httplib::Response& response) {
    const Lock lock(mutex_);
    response.set_content(text_, "text/plain; version=0.0.4; charset=utf-8");
  };
  server.Get("/", answer);
  server.Get("/metrics", answer);
  errno = 0;
  if (!server.bind_to_port(address.host, address.port))
    throw NetworkError("metrics: port " + std::to_string(address.port) + " of " + address.host + ": " +
                       std::strerror(errno == 0 ? EADDRINUSE : errno));
  serving_->thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();  // else stop() would stop nothing
}

PrometheusPort::~PrometheusPort() {
  serving_->server.stop();
  serving_->thread.join();
}

void PrometheusPort::Set(std::string text) {
  const Lock lock(mutex_);
  text_ = std::move(text);
}

}  // namespace dispersa
