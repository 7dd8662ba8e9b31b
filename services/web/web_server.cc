#include "services/web/web_server.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sys/stat.h>

#include <array>
#include <charconv>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "core/input/input_error.h"
#include "services/http/http_server.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

constexpr int kWebThreads = 4;
constexpr std::size_t kConnectionsOfPeer = 32;
constexpr std::size_t kLeastToken = 16;
constexpr std::chrono::milliseconds kWrongToken(300);  // whoever tries tokens waits
constexpr char kCookie[] = "dispersa";
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

HttpAnswer Html(std::string html, int status = 200) {
  HttpAnswer answer;
  answer.status = status;
  answer.body = std::move(html);
  return answer;
}

HttpAnswer Problem(int status, const std::string& title, const std::string& text) {
  return Html(ErrorPage(title, text), status);
}

HttpAnswer NoSuchCampaign() {
  return Problem(404, "No such campaign", "No campaign, or more than one, has an id that begins so.");
}

constexpr std::size_t kMostOfId = 128;  // with the engine that flew it

std::int64_t Now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Only whoever has the token can make it.
std::string Signature(const std::string& token, const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  HMAC(EVP_sha256(), token.data(), static_cast<int>(token.size()),
       reinterpret_cast<const unsigned char*>(text.data()), text.size(), bytes.data(), &size);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += kDigits[bytes[i] >> 4];
    hex += kDigits[bytes[i] & 15];
  }
  return hex;
}

/// Value of the cookie of a session that ends at `end_s`: "1790000000.<signature>".
std::string SessionUntil(const std::string& token, std::int64_t end_s) {
  const std::string end = std::to_string(end_s);
  return end + "." + Signature(token, "session until " + end);
}

bool IsSession(const std::string& cookie, const std::string& token) {
  std::int64_t end_s = 0;
  const auto read = std::from_chars(cookie.data(), cookie.data() + cookie.size(), end_s);
  return read.ec == std::errc() && IsSame(cookie, SessionUntil(token, end_s)) && Now_s() < end_s;
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

WebServer::WebServer(const WebOptions& options, CampaignFile file)
    : options_(options), file_(std::move(file)) {
  HttpOptions http;
  http.address = options.address;
  http.owner_alone = options.token.empty();
  http.threads = kWebThreads;
  // Behind a proxy all peers are the proxy.
  if (!options.behind_tls) http.limits.connections_of_peer = kConnectionsOfPeer;
  http.headers = {{"X-Content-Type-Options", "nosniff"},
                  {"Cross-Origin-Resource-Policy", "same-origin"},
                  {"Referrer-Policy", "same-origin"},
                  {"Cache-Control", "no-store"},
                  {"Content-Security-Policy", kPolicy}};
  try {
    server_ = std::make_unique<HttpServer>(http, [this](const HttpRequest& request) {
      auto refusal = Refusal(request);
      return refusal ? *std::move(refusal) : Answer(request);
    });
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string("web: ") + error.what());
  }
}

WebServer::~WebServer() = default;

void WebServer::Set(std::shared_ptr<const CampaignIndex> index) {
  const Lock lock(mutex_);
  index_ = std::move(index);
}

std::shared_ptr<const CampaignIndex> WebServer::index() {
  const Lock lock(mutex_);
  return index_;
}

std::optional<HttpAnswer> WebServer::Refusal(const HttpRequest& request) const {
  if (options_.behind_tls && request.Header("x-forwarded-proto") != "https")
    return Problem(403, "Over TLS alone", "This address answers only what a proxy has received over TLS.");
  if (options_.token.empty()) {
    if (request.NamesThisMachine()) return std::nullopt;
    return Problem(403, "On this machine alone", "These pages are at 127.0.0.1 and localhost.");
  }
  if (request.path == "/login" || request.path == "/style.css") return std::nullopt;
  if (IsSame(request.Header("authorization"), "Bearer " + options_.token) ||
      IsSession(request.Cookie(kCookie), options_.token))
    return std::nullopt;
  if (request.method == "GET" && !request.HasParameter("part"))
    return RedirectTo("/login?next=" + UrlText(request.target));
  return Problem(401, "Sign in", "These pages need a token.");
}

HttpAnswer WebServer::LogIn(const HttpRequest& request) const {
  const std::string next = LocalPath(request.Parameter("next"));
  if (options_.token.empty() || !IsSame(request.Parameter("token"), options_.token)) {
    HttpAnswer answer = Html(LoginPage(next, true), 403);
    answer.delay = kWrongToken;
    return answer;
  }
  HttpAnswer answer = RedirectTo(next, 303);
  const std::int64_t length_s = options_.session.count();
  answer.headers.emplace_back("Set-Cookie",
                              std::string(kCookie) + "=" + SessionUntil(options_.token, Now_s() + length_s) +
                                  "; Path=/; HttpOnly; SameSite=Lax; Max-Age=" + std::to_string(length_s) +
                                  (options_.behind_tls ? "; Secure" : ""));
  return answer;
}

HttpAnswer WebServer::Answer(const HttpRequest& request) {
  const std::string& path = request.path;
  if (request.method == "POST" && path == "/login") return LogIn(request);
  if (request.method != "GET") return Problem(404, "Not here", "There is no such page.");
  if (path == "/login") return Html(LoginPage(LocalPath(request.Parameter("next")), false));
  if (path == "/style.css") return {200, WebStyleSheet(), "text/css; charset=utf-8", {}, {}};
  if (path == "/script.js") return {200, std::string(WebScript()), "text/javascript; charset=utf-8", {}, {}};
  if (path == "/")
    return Html(ListPage(*index(), request.Parameter("q"), PageNumber(request.Parameter("page"))));
  if (path == "/trend") return Html(TrendPage(*index(), request.Parameter("metric"), request.Parameter("q")));
  if (path == "/difference") return Difference(request);
  const std::string before = "/campaign/", after = "/report";
  if (!path.starts_with(before)) return Problem(404, "Not here", "There is no such page.");
  std::string id = path.substr(before.size());
  const bool is_report = id.ends_with(after);
  if (is_report) id.resize(id.size() - after.size());
  if (id.empty() || id.size() > kMostOfId || id.find_first_not_of("0123456789abcdef-") != std::string::npos)
    return Problem(404, "Not here", "There is no such page.");
  return is_report ? Report(id) : Campaign(id, request.HasParameter("part"));
}

HttpAnswer WebServer::Campaign(const std::string& id, bool part) {
  const auto all = index();
  const CampaignRow* row = all->Find(id);
  if (row == nullptr) return NoSuchCampaign();
  if (row->id != id) return RedirectTo(LinkTo(*row));
  const bool has_report = row->state == "done";
  HttpAnswer answer =
      Html(part ? CampaignPart(*all, *row, has_report) : CampaignPage(*all, *row, has_report));
  if (row->has_ended) answer.headers.emplace_back("X-Campaign-Ended", "1");
  return answer;
}

HttpAnswer WebServer::Report(const std::string& id) {
  const auto all = index();
  const CampaignRow* row = all->Find(id);
  if (row == nullptr) return NoSuchCampaign();
  auto report = row->state == "done" ? file_(row->id, "report.html") : std::nullopt;
  if (!report) return Problem(404, "No report", "This campaign has no report.");
  HttpAnswer answer = Html(*std::move(report));
  answer.headers.emplace_back("Content-Security-Policy", kReportPolicy);
  return answer;
}

HttpAnswer WebServer::Difference(const HttpRequest& request) {
  const auto all = index();
  const CampaignRow* a = all->Find(request.Parameter("id", 0));
  const CampaignRow* b = all->Find(request.Parameter("id", 1));
  if (a == nullptr || b == nullptr)
    return Problem(404, "Two campaigns", "Mark two campaigns in the list to see what differs.");
  return Html(a->order <= b->order ? DifferencePage(*a, *b, file_) : DifferencePage(*b, *a, file_));
}

}  // namespace dispersa
