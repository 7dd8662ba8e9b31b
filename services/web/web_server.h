// The web application of a coordinator: campaigns to read, over HTTP.
#pragma once

#include <memory>
#include <string>

#include "services/program/mutex.h"
#include "services/web/http_address.h"
#include "services/web/pages.h"

namespace dispersa {

struct WebOptions {
  HttpAddress address;
  std::string token;        ///< who reads has to know it; empty: whoever reaches the address
  bool behind_tls = false;  ///< a proxy stands before it: what has not come to it over TLS is refused
};

/// Why these options are too open: beyond loopback a token and a proxy with TLS are needed. Empty: they are
/// not.
std::string WhyTooOpen(const WebOptions& options);

/// The token in a file: its first line. Throws InputError if it has fewer than 16 characters, or if other
/// users can read the file.
std::string ReadWebToken(const std::string& file);

/// Answers GET alone, on threads of its own, with the campaigns that were set last. On loopback without a
/// token it answers only under the names of this machine, so no page from elsewhere reaches it by a name of
/// its own. Throws std::runtime_error if the port is taken.
class WebServer {
 public:
  /// `file` is called on the server's threads.
  WebServer(const WebOptions& options, CampaignFile file);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  void Set(std::shared_ptr<const CampaignIndex> index);

 private:
  struct Serving;

  std::shared_ptr<const CampaignIndex> index();
  void AddGuard();
  void AddRoutes();
  void AddLogin();

  WebOptions options_;
  CampaignFile file_;
  std::string session_;  ///< value of the cookie
  Mutex mutex_;
  std::shared_ptr<const CampaignIndex> index_ DISPERSA_GUARDED_BY(mutex_) = std::make_shared<CampaignIndex>();
  std::unique_ptr<Serving> serving_;
};

}  // namespace dispersa
