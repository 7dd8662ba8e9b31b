#include "services/cli/live_server.h"

#include <httplib.h>
#include <sys/socket.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "services/cli/live_page.h"

namespace dispersa {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char kHost[] = "127.0.0.1";
/// Each has a thread; further ones are told to try again.
constexpr int kMaxViewers = 32;
constexpr std::size_t kThreads = kMaxViewers + 8;
/// Interval of messages to a browser, by which a closed one is noticed.
constexpr std::chrono::seconds kSignOfLife(2);
constexpr std::chrono::seconds kFarewell(2);
constexpr int kWritePatience_s = 2;
constexpr std::size_t kMaxBody = 1024;

/// Without it a page from elsewhere, whose name's owner points it to 127.0.0.1, could read this one.
bool NamesThisMachine(const httplib::Request& request) {
  if (request.get_header_value_count("Host") != 1) return false;
  const std::string host = request.get_header_value("Host");
  return std::set<std::string>{"127.0.0.1", "localhost"}.contains(host.substr(0, host.find(':')));
}

}  // namespace

struct LiveServer::Serving {
  httplib::Server server;
  std::thread thread;
};

LiveServer::LiveServer(std::uint16_t port, std::string page)
    : page_(std::move(page)), serving_(std::make_unique<Serving>()) {
  httplib::Server& server = serving_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // By default httplib lets other programs listen on the same port.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_write_timeout(kWritePatience_s);
  server.set_payload_max_length(kMaxBody);
  server.set_default_headers({{"Content-Security-Policy", ContentSecurityPolicy(page_)},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-store"}});
  AddRoutes();
  if (port == 0) {
    port_ = server.bind_to_any_port(kHost);
  } else if (server.bind_to_port(kHost, port)) {
    port_ = port;
  }
  if (port_ <= 0) throw std::runtime_error("port " + std::to_string(port) + " of 127.0.0.1 is not free");
  serving_->thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();  // else stop() would stop nothing
}

LiveServer::~LiveServer() {
  {
    const Lock lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  serving_->server.stop();
  serving_->thread.join();
}

std::string LiveServer::Url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/"; }

void LiveServer::AddRoutes() {
  httplib::Server& server = serving_->server;
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (NamesThisMachine(request)) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    response.set_content("This page is at 127.0.0.1 and localhost only.\n", "text/plain");
    return httplib::Server::HandlerResponse::Handled;
  });
  server.Get("/", [this](const httplib::Request&, httplib::Response& response) {
    response.set_content(page_, "text/html; charset=utf-8");
  });
  server.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
    {
      const Lock lock(mutex_);
      if (viewers_ >= kMaxViewers) {
        response.status = 503;
        response.set_content("Too many browsers watch already.\n", "text/plain");
        return;
      }
      ++viewers_;
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen = std::uint64_t{0}, told_end = false](std::size_t, httplib::DataSink& sink) mutable {
          const std::string event = NextEvent(&seen, &told_end);
          if (event.empty()) {
            sink.done();
            return true;
          }
          return sink.write(event.data(), event.size());
        },
        [this](bool) {
          const Lock lock(mutex_);
          --viewers_;
          changed_.notify_all();
        });
  });
}

void LiveServer::Show(const LiveParts& parts) {
  const Lock lock(mutex_);
  for (const auto& [id, html] : parts) {
    Part& part = parts_[id];
    if (part.version > 0 && part.html == html) continue;
    part = {html, ++version_};
  }
  changed_.notify_all();
}

std::string LiveServer::NextEvent(std::uint64_t* seen, bool* told_end) {
  const auto deadline = Clock::now() + kSignOfLife;
  Lock lock(mutex_);
  while (*seen == version_ && !ended_ && !closing_ && lock.WaitUntil(changed_, deadline)) {
  }
  if (closing_ || *told_end) return "";
  nlohmann::json news = nlohmann::json::object();
  for (const auto& [id, part] : parts_) {
    if (part.version > *seen) news[id] = part.html;
  }
  *seen = version_;
  std::string event =
      "event: show\ndata: " + news.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n\n";
  if (ended_) {
    *told_end = true;
    event += "event: end\ndata:\n\n";
  }
  return event;
}

void LiveServer::End() {
  const auto deadline = Clock::now() + kFarewell;
  Lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
  while (viewers_ > 0 && lock.WaitUntil(changed_, deadline)) {
  }
}

}  // namespace dispersa
