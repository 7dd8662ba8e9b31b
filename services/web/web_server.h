// The web application of a coordinator: campaigns to read, over HTTP.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "services/http/http_address.h"
#include "services/http/http_message.h"
#include "services/program/mutex.h"
#include "services/web/pages.h"

namespace dispersa {

class HttpServer;

struct WebOptions {
  HttpAddress address;
  std::string token;        ///< who reads has to know it; empty: the user of this process alone reads
  bool behind_tls = false;  ///< a proxy stands before it: what has not come to it over TLS is refused
  std::chrono::seconds session =
      std::chrono::hours(12);  ///< after which a browser is asked for the token again
};

/// Why these options are too open: beyond loopback a token and a proxy with TLS are needed. Empty: they are
/// not.
std::string WhyTooOpen(const WebOptions& options);

/// The token in a file: its first line. Throws InputError if it has fewer than 16 characters, or if other
/// users can read the file.
std::string ReadWebToken(const std::string& file);

/// Answers GET alone, on threads of its own, with the campaigns that were set last. On loopback without a
/// token it answers its own user alone, and only under the names of this machine, so no page from elsewhere
/// reaches it by a name of its own. Throws std::runtime_error if the port is taken.
class WebServer {
 public:
  /// `file` is called on the server's threads.
  WebServer(const WebOptions& options, CampaignFile file);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  void Set(std::shared_ptr<const CampaignIndex> index);

 private:
  std::shared_ptr<const CampaignIndex> index();
  /// None: the request may be answered.
  std::optional<HttpAnswer> Refusal(const HttpRequest& request) const;
  HttpAnswer Answer(const HttpRequest& request);
  HttpAnswer LogIn(const HttpRequest& request) const;
  HttpAnswer Campaign(const std::string& id, bool part);
  HttpAnswer Report(const std::string& id);
  HttpAnswer Difference(const HttpRequest& request);

  WebOptions options_;
  CampaignFile file_;
  Mutex mutex_;
  std::shared_ptr<const CampaignIndex> index_ DISPERSA_GUARDED_BY(mutex_) = std::make_shared<CampaignIndex>();
  std::unique_ptr<HttpServer> server_;  // ends before what it reads
};

}  // namespace dispersa
