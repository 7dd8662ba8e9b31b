// The one skeleton of an HTTP server: web application and Prometheus figures are handlers of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "services/http/http_address.h"
#include "services/http/http_message.h"

namespace dispersa {

/// Totals, whatever a peer sends and in whichever pieces.
struct HttpLimits {
  std::size_t request_line = 4096;              ///< bytes of the target
  std::size_t head = 8192;                      ///< bytes of request line and headers
  std::size_t body = 4096;                      ///< bytes, also of a body in chunks
  std::chrono::milliseconds request{5000};      ///< from the connection to the request's last byte
  std::chrono::milliseconds answer{10000};      ///< until the peer has read the answer, and 20 s per MB
  std::size_t answers = std::size_t{64} << 20;  ///< bytes of all answers that are being read
  std::size_t connections = 64;                 ///< at once
  std::size_t connections_of_peer = 64;         ///< of an address; on loopback of a user
};

struct HttpOptions {
  HttpAddress address;  ///< port 0: any that is free
  HttpLimits limits;
  bool owner_alone = false;  ///< answers the user of this process and root; needs an address on loopback
  int threads = 1;           ///< on which the handler runs
  HttpPairs headers;         ///< of every answer
};

/// Makes the answer to GET, HEAD and POST; runs on `threads` threads at once.
using HttpHandler = std::function<HttpAnswer(const HttpRequest&)>;

/// Each connection has one request. Beyond the limits of connections a new one takes the place of the oldest
/// whose request is not whole: slow peers cannot keep a good one out.
class HttpServer {
 public:
  /// Throws std::runtime_error: "port 80 of 127.0.0.1: Permission denied".
  HttpServer(const HttpOptions& options, HttpHandler handler);
  /// Returns when the handler runs no more. Connections are cut.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const;

 private:
  class Serving;
  std::unique_ptr<Serving> serving_;
};

}  // namespace dispersa
