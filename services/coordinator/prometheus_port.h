// An HTTP port of the loopback interface for Prometheus.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "services/program/mutex.h"

namespace dispersa {

/// Answers GET of / and /metrics on 127.0.0.1 with the last text set. Throws NetworkError if the port is
/// taken.
class PrometheusPort {
 public:
  explicit PrometheusPort(std::uint16_t port);
  ~PrometheusPort();
  PrometheusPort(const PrometheusPort&) = delete;
  PrometheusPort& operator=(const PrometheusPort&) = delete;

  /// In Prometheus' text format.
  void Set(std::string text);

 private:
  struct Serving;

  Mutex mutex_;
  std::string text_ DISPERSA_GUARDED_BY(mutex_);
  std::unique_ptr<Serving> serving_;
};

}  // namespace dispersa
