// Metrics for Prometheus on a port of the loopback interface.
#pragma once

#include <cstdint>
#include <string>
#include <thread>

#include "services/program/mutex.h"

namespace dispersa {

/// Answers every HTTP request on 127.0.0.1 with the text that was set last. What a caller sends is not looked
/// at: there is one answer. Throws std::runtime_error if the port is not free.
class MetricsPort {
 public:
  explicit MetricsPort(std::uint16_t port);
  ~MetricsPort();
  MetricsPort(const MetricsPort&) = delete;
  MetricsPort& operator=(const MetricsPort&) = delete;

  /// In Prometheus' text format.
  void Set(std::string text);

 private:
  void Serve(const std::stop_token& stop);
  void Answer(int connection);

  int socket_ = -1;
  Mutex mutex_;
  std::string text_ DISPERSA_GUARDED_BY(mutex_);
  std::jthread thread_;
};

}  // namespace dispersa
