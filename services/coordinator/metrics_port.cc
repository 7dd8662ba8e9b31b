#include "services/coordinator/metrics_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "services/transport/network.h"

namespace dispersa {
namespace {

constexpr int kPeriod_ms = 200;    // in which a stop is noticed
constexpr int kPatience_ms = 500;  // with a caller: the next one waits

}  // namespace

MetricsPort::MetricsPort(std::uint16_t port) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(port);
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int reuse = 1;
  if (socket_ < 0 || setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse) != 0 ||
      bind(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0 ||
      listen(socket_, 16) != 0) {
    const std::string reason = std::strerror(errno);
    if (socket_ >= 0) close(socket_);
    throw NetworkError("metrics: port " + std::to_string(port) + " of 127.0.0.1: " + reason);
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { Serve(stop); });
}

MetricsPort::~MetricsPort() {
  thread_.request_stop();
  thread_.join();
  close(socket_);
}

void MetricsPort::Set(std::string text) {
  const Lock lock(mutex_);
  text_ = std::move(text);
}

void MetricsPort::Serve(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd waiting{socket_, POLLIN, 0};
    if (poll(&waiting, 1, kPeriod_ms) <= 0) continue;
    const int connection = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (connection < 0) continue;
    Answer(connection);
    close(connection);
  }
}

void MetricsPort::Answer(int connection) {
  // One read takes the request of any scraper; what it holds does not matter, but unread it would reset the
  // connection.
  pollfd ready{connection, POLLIN, 0};
  std::array<char, 4096> request{};
  if (poll(&ready, 1, kPatience_ms) <= 0 || recv(connection, request.data(), request.size(), 0) <= 0) return;
  std::string text;
  {
    const Lock lock(mutex_);
    text = text_;
  }
  const std::string answer =
      "HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nConnection: "
      "close\r\nContent-Length: " +
      std::to_string(text.size()) + "\r\n\r\n" + text;
  for (std::size_t sent = 0; sent < answer.size();) {
    ready.events = POLLOUT;
    if (poll(&ready, 1, kPatience_ms) <= 0) return;
    const ssize_t now = send(connection, answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) return;
    sent += static_cast<std::size_t>(now);
  }
  shutdown(connection, SHUT_WR);
}

}  // namespace dispersa
