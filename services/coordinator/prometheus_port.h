// An HTTP port for Prometheus.
#pragma once

#include <memory>
#include <string>

#include "services/http/http_address.h"
#include "services/program/mutex.h"

namespace dispersa {

class HttpServer;

/// Answers GET of / and /metrics with the last text set. Throws NetworkError if the port is taken, or the
/// address is none of this machine.
class PrometheusPort {
 public:
  explicit PrometheusPort(const HttpAddress& address);
  ~PrometheusPort();
  PrometheusPort(const PrometheusPort&) = delete;
  PrometheusPort& operator=(const PrometheusPort&) = delete;

  /// In Prometheus' text format.
  void Set(std::string text);

 private:
  Mutex mutex_;
  std::string text_ DISPERSA_GUARDED_BY(mutex_);
  std::unique_ptr<HttpServer> server_;  // ends before what it reads
};

}  // namespace dispersa
