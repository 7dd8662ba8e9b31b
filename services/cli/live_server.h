// A page on this machine that changes while it is open.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "services/http/http_message.h"
#include "services/program/mutex.h"

namespace dispersa {

class HttpServer;

/// HTML by the id of its element; for "title" a text.
using LiveParts = std::map<std::string, std::string>;

/// Serves one page to its user's browsers on this machine and sends them its changes. It listens on 127.0.0.1
/// only, answers no other user, and answers only under the names of this machine. So a page from another site
/// cannot reach it under another name. It keeps the present page for up to 32 browsers. A browser that stops
/// reading is dropped.
class LiveServer {
 public:
  /// `page` connects to "events" (LivePage()). Port 0: any that is free. Throws std::runtime_error.
  LiveServer(std::uint16_t port, std::string page);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  std::string Url() const;
  /// Changes parts of the page.
  void Show(const LiveParts& parts);
  /// Nothing more comes: returns when every browser knows, or after 2 s.
  void End();

 private:
  struct Part {
    std::string html;
    std::uint64_t version = 0;
  };
  struct Viewer;

  HttpAnswer Answer(const HttpRequest& request);
  /// The parts of the page that a browser lacks, or a sign of life now and then. Empty: neither. None:
  /// nothing follows.
  std::optional<std::string> NextEvent(Viewer* viewer);

  std::string page_;
  Mutex mutex_;
  std::condition_variable changed_;  ///< viewers_
  std::map<std::string, Part> parts_ DISPERSA_GUARDED_BY(mutex_);
  std::uint64_t version_ DISPERSA_GUARDED_BY(mutex_) = 0;
  int viewers_ DISPERSA_GUARDED_BY(mutex_) = 0;
  bool ended_ DISPERSA_GUARDED_BY(mutex_) = false;
  std::unique_ptr<HttpServer> server_;  // ends before what it reads
};

}  // namespace dispersa
