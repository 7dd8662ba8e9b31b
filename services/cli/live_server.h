// A page on this machine that changes while it is open.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "services/program/mutex.h"

namespace httplib {
class Server;
}

namespace dispersa {

/// HTML by the id of its element; for "title" a text.
using LiveParts = std::map<std::string, std::string>;

/// Serves one page to the browsers of this machine and sends them its changes. It listens on 127.0.0.1 only,
/// and answers only under the names of this machine. So a page from another site cannot reach it under
/// another name. It keeps the present page for any number of browsers. A browser that stops reading is
/// dropped.
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
  struct Serving;

  /// The parts that a browser at state `seen` lacks, or a sign of life. Waits for them. Empty if nothing
  /// follows.
  std::string NextEvent(std::uint64_t* seen, bool* told_end);
  void AddRoutes();

  std::string page_;
  int port_ = 0;
  Mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Part> parts_ DISPERSA_GUARDED_BY(mutex_);
  std::uint64_t version_ DISPERSA_GUARDED_BY(mutex_) = 0;
  int viewers_ DISPERSA_GUARDED_BY(mutex_) = 0;
  bool ended_ DISPERSA_GUARDED_BY(mutex_) = false;
  bool closing_ DISPERSA_GUARDED_BY(mutex_) = false;
  std::unique_ptr<Serving> serving_;
};

}  // namespace dispersa
