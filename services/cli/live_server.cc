#include "services/cli/live_server.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/cli/live_page.h"
#include "services/http/http_server.h"

namespace dispersa {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxViewers = 32;
/// Interval of messages to a browser, by which a closed one is noticed.
constexpr std::chrono::seconds kSignOfLife(2);
constexpr std::chrono::seconds kFarewell(2);

HttpAnswer Words(int status, const std::string& words) { return {status, words, "text/plain", {}, {}, {}}; }

}  // namespace

/// What one browser has been told.
struct LiveServer::Viewer {
  explicit Viewer(LiveServer& its_server) : server(its_server) {}
  ~Viewer() {
    const Lock lock(server.mutex_);
    --server.viewers_;
    server.changed_.notify_all();
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  LiveServer& server;
  std::uint64_t seen = 0;
  bool told_end = false;
  Clock::time_point told = Clock::time_point::min();
};

LiveServer::LiveServer(std::uint16_t port, std::string page) : page_(std::move(page)) {
  HttpOptions options;
  options.address.port = port;
  options.owner_alone = true;
  options.headers = {{"Content-Security-Policy", ContentSecurityPolicy(page_)},
                     {"X-Content-Type-Options", "nosniff"},
                     {"Cross-Origin-Resource-Policy", "same-origin"},
                     {"Referrer-Policy", "no-referrer"},
                     {"Cache-Control", "no-store"}};
  server_ =
      std::make_unique<HttpServer>(options, [this](const HttpRequest& request) { return Answer(request); });
}

LiveServer::~LiveServer() = default;

std::string LiveServer::Url() const { return "http://127.0.0.1:" + std::to_string(server_->port()) + "/"; }

HttpAnswer LiveServer::Answer(const HttpRequest& request) {
  if (!request.NamesThisMachine()) return Words(403, "This page is at 127.0.0.1 and localhost only.\n");
  HttpAnswer answer;
  if (request.method == "GET" && request.path == "/") {
    answer.body = page_;
    return answer;
  }
  if (request.method != "GET" || request.path != "/events") return Words(404, "There is no such page.\n");
  {
    const Lock lock(mutex_);
    if (viewers_ >= kMaxViewers) return Words(503, "Too many browsers watch already.\n");
    ++viewers_;
  }
  answer.type = "text/event-stream";
  answer.more = [viewer = std::make_shared<Viewer>(*this)] { return viewer->server.NextEvent(viewer.get()); };
  return answer;
}

void LiveServer::Show(const LiveParts& parts) {
  const Lock lock(mutex_);
  for (const auto& [id, html] : parts) {
    Part& part = parts_[id];
    if (part.version > 0 && part.html == html) continue;
    part = {html, ++version_};
  }
}

std::optional<std::string> LiveServer::NextEvent(Viewer* viewer) {
  if (viewer->told_end) return std::nullopt;
  const Lock lock(mutex_);
  if (viewer->seen == version_ && !ended_ && Clock::now() < viewer->told + kSignOfLife) return "";
  nlohmann::json news = nlohmann::json::object();
  for (const auto& [id, part] : parts_) {
    if (part.version > viewer->seen) news[id] = part.html;
  }
  viewer->seen = version_;
  viewer->told = Clock::now();
  std::string event =
      "event: show\ndata: " + news.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n\n";
  if (ended_) {
    viewer->told_end = true;
    event += "event: end\ndata:\n\n";
  }
  return event;
}

void LiveServer::End() {
  const auto deadline = Clock::now() + kFarewell;
  Lock lock(mutex_);
  ended_ = true;
  while (viewers_ > 0 && lock.WaitUntil(changed_, deadline)) {
  }
}

}  // namespace dispersa
