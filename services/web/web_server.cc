#include "services/web/web_server.h"

#include <httplib.h>
#include <openssl/crypto.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/campaign_yaml/sha256.h"
#include "core/input/input_error.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

constexpr std::size_t kWebThreads = 8;
constexpr int kWebPatience_s = 5;
constexpr std::size_t kMaxWebBody = 4096;
constexpr std::size_t kLeastToken = 16;
constexpr std::chrono::milliseconds kWrongToken(300);  // whoever tries tokens waits
constexpr char kCookie[] = "dispersa";
constexpr char kHtml[] = "text/html; charset=utf-8";
constexpr char kPolicy[] =
    "default-src 'none'; style-src 'self'; script-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "form-action "
    "'self'; frame-ancestors 'none'; base-uri 'none'";
// A report has its style and its script in itself. It is made of texts of a client's campaign: in its sandbox
// it reads no other page.
constexpr char kReportPolicy[] =
    "sandbox allow-scripts; default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "img-src data:; "
    "frame-ancestors 'none'; base-uri 'none'";

bool IsSame(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

bool IsOfThisMachine(const httplib::Request& request) {
  if (request.get_header_value_count("Host") != 1) return false;
  const std::string host = request.get_header_value("Host");
  return std::set<std::string>{"127.0.0.1", "localhost"}.contains(host.substr(0, host.find(':')));
}

std::string CookieOf(const httplib::Request& request) {
  const std::string all = request.get_header_value("Cookie"), wanted = std::string(kCookie) + "=";
  std::size_t at = 0;
  while (at < all.size()) {
    std::size_t end = all.find(';', at);
    if (end == std::string::npos) end = all.size();
    while (at < end && all[at] == ' ') ++at;
    if (all.compare(at, wanted.size(), wanted) == 0)
      return all.substr(at + wanted.size(), end - at - wanted.size());
    at = end + 1;
  }
  return "";
}

void Answer(httplib::Response& response, int status, const std::string& html) {
  response.status = status;
  response.set_content(html, kHtml);
}

std::size_t PageNumber(const std::string& text) {
  std::size_t page = 0;
  for (const char c : text.substr(0, 6)) {
    if (c < '0' || c > '9') return 1;
    page = 10 * page + static_cast<std::size_t>(c - '0');
  }
  return page;
}

}  // namespace

std::string WhyTooOpen(const WebOptions& options) {
  if (options.behind_tls && options.token.empty()) return "--web-behind-tls needs --web-token FILE";
  if (IsOnLoopback(options.address) || options.behind_tls) return "";
  return "--web beyond 127.0.0.1 needs --web-token FILE and --web-behind-tls: a proxy before it that speaks "
         "TLS";
}

std::string ReadWebToken(const std::string& file) {
  struct stat what {};
  std::ifstream stream(file);
  std::string token;
  if (!std::getline(stream, token) || stat(file.c_str(), &what) != 0)
    throw InputError(file + ": no token can be read", "a file whose first line is the token");
  if ((what.st_mode & 0007) != 0)
    throw InputError(file + ": other users of this machine can use it", "a file after `chmod 640`");
  if (token.size() < kLeastToken)
    throw InputError(file + ": the token is too short", "16 characters or more");
  return token;
}

struct WebServer::Serving {
  httplib::Server server;
  std::thread thread;
};

WebServer::WebServer(const WebOptions& options, CampaignFile file)
    : options_(options),
      file_(std::move(file)),
      session_(options.token.empty() ? "" : Sha256Hex("session of " + options.token)),
      serving_(std::make_unique<Serving>()) {
  httplib::Server& server = serving_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kWebThreads); };
  // By default httplib lets other programs listen on the same port.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_keep_alive_timeout(1);
  server.set_read_timeout(kWebPatience_s);
  server.set_write_timeout(kWebPatience_s);
  server.set_payload_max_length(kMaxWebBody);
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "same-origin"},
                              {"Cache-Control", "no-store"}});
  AddGuard();
  AddLogin();
  AddRoutes();
  errno = 0;
  if (!server.bind_to_port(options.address.host, options.address.port)) {
    throw std::runtime_error("web: port " + std::to_string(options.address.port) + " of " +
                             options.address.host + ": " + std::strerror(errno == 0 ? EADDRINUSE : errno));
  }
  serving_->thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();  // else stop() would stop nothing
}

WebServer::~WebServer() {
  serving_->server.stop();
  serving_->thread.join();
}

void WebServer::Set(std::shared_ptr<const CampaignIndex> index) {
  const Lock lock(mutex_);
  index_ = std::move(index);
}

std::shared_ptr<const CampaignIndex> WebServer::index() {
  const Lock lock(mutex_);
  return index_;
}

void WebServer::AddGuard() {
  serving_->server.set_pre_routing_handler([this](const httplib::Request& request,
                                                  httplib::Response& response) {
    using Handled = httplib::Server::HandlerResponse;
    response.set_header("Content-Security-Policy", kPolicy);
    if (options_.behind_tls && request.get_header_value("X-Forwarded-Proto") != "https") {
      Answer(response, 403,
             ErrorPage("Over TLS alone", "This address answers only what a proxy has received over TLS."));
      return Handled::Handled;
    }
    if (options_.token.empty()) {
      if (IsOfThisMachine(request)) return Handled::Unhandled;
      Answer(response, 403,
             ErrorPage("On this machine alone", "These pages are at 127.0.0.1 and localhost."));
      return Handled::Handled;
    }
    if (request.path == "/login" || request.path == "/style.css") return Handled::Unhandled;
    if (IsSame(request.get_header_value("Authorization"), "Bearer " + options_.token) ||
        IsSame(CookieOf(request), session_))
      return Handled::Unhandled;
    if (request.method == "GET" && !request.has_param("part")) {
      response.set_redirect("/login?next=" + UrlText(request.target));
    } else {
      Answer(response, 401, ErrorPage("Sign in", "These pages need a token."));
    }
    return Handled::Handled;
  });
  serving_->server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty()) response.set_content(ErrorPage("Not here", "There is no such page."), kHtml);
  });
}

void WebServer::AddLogin() {
  serving_->server.Get("/login", [](const httplib::Request& request, httplib::Response& response) {
    response.set_content(LoginPage(LocalPath(request.get_param_value("next")), false), kHtml);
  });
  serving_->server.Post("/login", [this](const httplib::Request& request, httplib::Response& response) {
    const std::string next = LocalPath(request.get_param_value("next"));
    if (options_.token.empty() || !IsSame(request.get_param_value("token"), options_.token)) {
      std::this_thread::sleep_for(kWrongToken);
      Answer(response, 403, LoginPage(next, true));
      return;
    }
    response.set_header("Set-Cookie", std::string(kCookie) + "=" + session_ +
                                          "; Path=/; HttpOnly; SameSite=Lax; Max-Age=2592000" +
                                          (options_.behind_tls ? "; Secure" : ""));
    response.set_redirect(next, 303);
  });
}

void WebServer::AddRoutes() {
  httplib::Server& server = serving_->server;
  server.Get("/style.css", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(WebStyleSheet(), "text/css; charset=utf-8");
  });
  server.Get("/script.js", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(std::string(WebScript()), "text/javascript; charset=utf-8");
  });
  server.Get("/", [this](const httplib::Request& request, httplib::Response& response) {
    response.set_content(
        ListPage(*index(), request.get_param_value("q"), PageNumber(request.get_param_value("page"))), kHtml);
  });
  const auto none = [](httplib::Response& response) {
    Answer(response, 404,
           ErrorPage("No such campaign", "No campaign, or more than one, has an id that begins so."));
  };
  server.Get("/campaign/([0-9a-f]{1,64})",
             [this, none](const httplib::Request& request, httplib::Response& response) {
               const auto all = index();
               const CampaignRow* row = all->Find(request.matches[1]);
               if (row == nullptr) return none(response);
               if (row->id != request.matches[1].str()) return response.set_redirect(LinkTo(*row));
               const bool has_report = row->state == "done";
               if (row->has_ended) response.set_header("X-Campaign-Ended", "1");
               response.set_content(request.has_param("part") ? CampaignPart(*all, *row, has_report)
                                                              : CampaignPage(*all, *row, has_report),
                                    kHtml);
             });
  server.Get("/campaign/([0-9a-f]{64})/report",
             [this, none](const httplib::Request& request, httplib::Response& response) {
               const auto all = index();
               const CampaignRow* row = all->Find(request.matches[1]);
               if (row == nullptr) return none(response);
               auto report = row->state == "done" ? file_(row->id, "report.html") : std::nullopt;
               if (!report)
                 return Answer(response, 404, ErrorPage("No report", "This campaign has no report."));
               response.headers.erase("Content-Security-Policy");
               response.set_header("Content-Security-Policy", kReportPolicy);
               response.set_content(*std::move(report), kHtml);
             });
  server.Get("/difference", [this](const httplib::Request& request, httplib::Response& response) {
    const auto all = index();
    const CampaignRow* a = all->Find(request.get_param_value("id", 0));
    const CampaignRow* b = all->Find(request.get_param_value("id", 1));
    if (a == nullptr || b == nullptr)
      return Answer(response, 404,
                    ErrorPage("Two campaigns", "Mark two campaigns in the list to see what differs."));
    response.set_content(a->order <= b->order ? DifferencePage(*a, *b, file_) : DifferencePage(*b, *a, file_),
                         kHtml);
  });
  server.Get("/trend", [this](const httplib::Request& request, httplib::Response& response) {
    response.set_content(TrendPage(*index(), request.get_param_value("metric"), request.get_param_value("q")),
                         kHtml);
  });
}

}  // namespace dispersa
