#include "services/http/http_server.h"

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <list>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "services/http/peer_owner.h"

namespace dispersa {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using Clock = std::chrono::steady_clock;
using Failing = boost::system::error_code;

// A peer that is refused while it sends would lose the words of the refusal with its connection.
constexpr std::chrono::milliseconds kFarewell(500);
constexpr std::size_t kFarewellBytes = 1 << 20;
constexpr std::chrono::milliseconds kNoFile(100);
constexpr std::chrono::milliseconds kAllHandled(5);
constexpr int kPatienceOfAdmission = 200;  // times kAllHandled
constexpr std::size_t kPiece = 4096;
constexpr std::chrono::milliseconds kAnswerPerMb(20000);

bool IsLoopback(const sockaddr_in& address) { return (ntohl(address.sin_addr.s_addr) >> 24) == 127; }

HttpAnswer InWords(int status, const std::string& words) {
  return {status, words + "\n", "text/plain; charset=utf-8", {}, {}};
}

std::string Small(boost::beast::string_view text) {
  std::string small(text.data(), text.size());
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return small;
}

/// Refusal of what is no request of ours.
HttpAnswer Refusal(const Failing& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return InWords(431, "The request's headers are too long.");
  if (error == http::error::body_limit) return InWords(413, "The request's body is too long.");
  return InWords(400, "This is no HTTP request.");
}

std::optional<HttpRequest> Read(const http::request<http::string_body>& message) {
  HttpRequest request;
  request.method = message.method() == http::verb::head ? "GET" : std::string(message.method_string());
  if (!ReadTarget(std::string(message.target()), &request)) return std::nullopt;
  for (const auto& field : message)
    request.headers.emplace_back(Small(field.name_string()), std::string(field.value()));
  const bool is_form = request.Header("content-type").starts_with("application/x-www-form-urlencoded");
  if (is_form && !ReadForm(message.body(), &request.parameters)) return std::nullopt;
  return request;
}

}  // namespace

// All but the handler runs on one thread.
class HttpServer::Serving {
 public:
  Serving(HttpOptions options, HttpHandler handler)
      : options_(std::move(options)),
        handler_(std::move(handler)),
        acceptor_(io_),
        pause_(io_),
        pool_(static_cast<std::size_t>(options_.threads)) {
    Listen();
    Accept();
    thread_ = std::thread([this] { Run(); });
  }
  ~Serving() {
    pool_.stop();
    pool_.join();
    io_.stop();
    thread_.join();
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  struct Peer {
    std::uint64_t key;           // of an address, or on loopback of a user
    std::optional<uid_t> owner;  // on loopback
  };
  enum class Stage { kReads, kIsLate, kIsHandled, kWaits, kWrites, kLeaves };

  struct Connection {
    Connection(asio::io_context& io, const HttpLimits& limits, asio::ip::tcp::socket its_socket,
               const Peer& its_peer)
        : socket(std::move(its_socket)), deadline(io), pause(io), peer(its_peer), buffer(limits.head) {
      parser.header_limit(static_cast<std::uint32_t>(limits.head));
      parser.body_limit(limits.body);
    }

    asio::ip::tcp::socket socket;
    asio::steady_timer deadline, pause;
    Peer peer;
    Stage stage = Stage::kReads;
    boost::beast::flat_buffer buffer;
    http::request_parser<http::string_body> parser;
    std::array<char, kPiece> dropped{};
    HttpAnswer answer;
    std::string head;
    std::size_t droppable = kFarewellBytes;
    bool is_head = false, is_whole = false, is_cut = false;
  };
  using Shared = std::shared_ptr<Connection>;

  void Run();
  void Listen();
  void Accept();
  void Admit(asio::ip::tcp::socket socket, const Peer& peer, int patience);
  static Peer PeerOf(int descriptor, const sockaddr_in& peer);
  static bool MayRead(const Peer& peer) { return peer.owner == geteuid() || peer.owner == uid_t{0}; }
  bool MakeRoom(std::uint64_t peer);
  bool CutOldest(std::uint64_t peer);
  void Cut(const Shared& connection);
  void LimitTime(const Shared& connection, std::chrono::milliseconds patience);
  void Receive(const Shared& connection);
  void Handle(const Shared& connection);
  void Send(const Shared& connection, HttpAnswer answer);
  void SendNow(const Shared& connection);
  void Drop(const Shared& connection);
  void Leave(const Shared& connection);
  std::string HeadOf(const HttpAnswer& answer) const;

  HttpOptions options_;
  HttpHandler handler_;
  asio::io_context io_{1};
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::uint16_t port_ = 0;
  std::list<Shared> connections_;  // the oldest first
  std::map<std::uint64_t, std::size_t> of_peer_;
  std::size_t answers_bytes_ = 0;
  asio::thread_pool pool_;
  std::thread thread_;
};

void HttpServer::Serving::Run() {
  while (true) {
    try {
      io_.run();
      return;
    } catch (const std::exception&) {
      // Memory has run out, or an answer could not go on: that connection's time ends it.
    }
  }
}

void HttpServer::Serving::Listen() {
  const HttpAddress& address = options_.address;
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int yes = 1;
  sockaddr_in where = {};
  const auto made = asio::ip::make_address_v4(address.host);
  where.sin_family = AF_INET;
  where.sin_port = htons(address.port);
  where.sin_addr.s_addr = htonl(made.to_uint());
  socklen_t size = sizeof where;
  const bool listens = descriptor >= 0 &&
                       setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                       bind(descriptor, reinterpret_cast<const sockaddr*>(&where), size) == 0 &&
                       listen(descriptor, SOMAXCONN) == 0 &&
                       getsockname(descriptor, reinterpret_cast<sockaddr*>(&where), &size) == 0;
  if (!listens) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) close(descriptor);
    throw std::runtime_error("port " + std::to_string(address.port) + " of " + address.host + ": " + why);
  }
  port_ = ntohs(where.sin_port);
  acceptor_.assign(asio::ip::tcp::v4(), descriptor);
}

void HttpServer::Serving::Accept() {
  acceptor_.async_wait(asio::ip::tcp::acceptor::wait_read, [this](const Failing& error) {
    if (error) return;
    sockaddr_in peer{};
    socklen_t size = sizeof peer;
    // Asio's own accept would leave it open in programs that this one starts.
    const int descriptor = accept4(acceptor_.native_handle(), reinterpret_cast<sockaddr*>(&peer), &size,
                                   SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor >= 0) {
      const int yes = 1;
      setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      const Peer who = PeerOf(descriptor, peer);
      Admit(asio::ip::tcp::socket(io_, asio::ip::tcp::v4(), descriptor), who, kPatienceOfAdmission);
    } else if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
      pause_.expires_after(kNoFile);
      pause_.async_wait([this](const Failing& stopped) {
        if (!stopped) Accept();
      });
    } else {
      Accept();
    }
  });
}

HttpServer::Serving::Peer HttpServer::Serving::PeerOf(int descriptor, const sockaddr_in& peer) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &size);
  if (!IsLoopback(own)) return {ntohl(peer.sin_addr.s_addr), std::nullopt};
  constexpr std::uint64_t kUsers = std::uint64_t{1} << 32;  // beyond all addresses
  const std::optional<uid_t> owner = PeerOwner(own, peer);
  return {kUsers + owner.value_or(~uid_t{0}), owner};
}

/// The next is accepted when this one has its place. `patience`: how often to look for one.
void HttpServer::Serving::Admit(asio::ip::tcp::socket socket, const Peer& peer, int patience) {
  if (!MakeRoom(peer.key)) {
    if (patience == 0) return Accept();
    pause_.expires_after(kAllHandled);
    return pause_.async_wait(
        [this, socket = std::move(socket), peer, patience](const Failing& error) mutable {
          if (!error) Admit(std::move(socket), peer, patience - 1);
        });
  }
  const auto connection = std::make_shared<Connection>(io_, options_.limits, std::move(socket), peer);
  connections_.push_back(connection);
  ++of_peer_[peer.key];
  LimitTime(connection, options_.limits.request);
  Receive(connection);
  Accept();
}

/// False: the answers of all are being made, which takes milliseconds, or go on.
bool HttpServer::Serving::MakeRoom(std::uint64_t peer) {
  const auto own = of_peer_.find(peer);
  if (own != of_peer_.end() && own->second >= options_.limits.connections_of_peer && !CutOldest(peer))
    return false;
  if (connections_.size() < options_.limits.connections) return true;
  const auto most = std::max_element(of_peer_.begin(), of_peer_.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return CutOldest(most->first);
}

/// Of a peer, one whose request is not whole, else one that reads its answer.
bool HttpServer::Serving::CutOldest(std::uint64_t peer) {
  for (const bool may_write : {false, true}) {
    for (const Shared& each : connections_) {
      const bool is_idle =
          each->stage == Stage::kReads || each->stage == Stage::kWaits || each->stage == Stage::kLeaves;
      if (each->peer.key != peer || !(is_idle || (may_write && each->stage == Stage::kWrites))) continue;
      Cut(Shared(each));
      return true;
    }
  }
  return false;
}

void HttpServer::Serving::Cut(const Shared& connection) {
  if (std::exchange(connection->is_cut, true)) return;
  Failing ignored;
  connection->socket.close(ignored);
  connection->deadline.cancel();
  connection->pause.cancel();
  answers_bytes_ -= connection->answer.body.size();
  connection->answer = {};
  connections_.remove(connection);
  const auto peer = of_peer_.find(connection->peer.key);
  if (--peer->second == 0) of_peer_.erase(peer);
}

void HttpServer::Serving::LimitTime(const Shared& connection, std::chrono::milliseconds patience) {
  const auto end = Clock::now() + patience;
  connection->deadline.expires_at(end);
  connection->deadline.async_wait([this, connection, end](const Failing& error) {
    // One that is set anew while this waits to run is another one.
    if (error || connection->is_cut || connection->deadline.expiry() != end) return;
    if (connection->stage == Stage::kReads && connection->parser.got_some()) {
      connection->stage = Stage::kIsLate;
      Failing ignored;
      connection->socket.cancel(ignored);
    } else {
      Cut(connection);
    }
  });
}

void HttpServer::Serving::Receive(const Shared& connection) {
  http::async_read(connection->socket, connection->buffer, connection->parser,
                   [this, connection](const Failing& error, std::size_t) {
                     if (connection->is_cut) return;
                     if (connection->stage == Stage::kIsLate)
                       return Send(connection, InWords(408, "The request took too long."));
                     if (!error) return Handle(connection);
                     // Others are the end of the connection.
                     if (error.category() == http::make_error_code(http::error::bad_method).category() &&
                         error != http::error::end_of_stream && error != http::error::partial_message)
                       return Send(connection, Refusal(error));
                     Cut(connection);
                   });
}

void HttpServer::Serving::Handle(const Shared& connection) {
  connection->is_whole = true;
  connection->deadline.cancel();
  const auto& message = connection->parser.get();
  connection->is_head = message.method() == http::verb::head;
  if (message.target().size() > options_.limits.request_line)
    return Send(connection, InWords(414, "The request's address is too long."));
  if (options_.owner_alone && !MayRead(connection->peer))
    return Send(connection, InWords(403,
                                    "Only the user who has started this program reads these pages. A "
                                    "coordinator with --web-token FILE "
                                    "lets in whoever has the token."));
  auto request = Read(message);
  if (!request) return Send(connection, InWords(400, "The request has a wrong escape (%)."));
  connection->stage = Stage::kIsHandled;
  asio::post(pool_, [this, connection, request = *std::move(request)] {
    HttpAnswer answer;
    try {
      answer = handler_(request);
    } catch (const std::exception&) {
      answer = InWords(500, "The page cannot be made.");
    }
    asio::post(io_, [this, connection, answer = std::move(answer)]() mutable {
      if (!connection->is_cut) Send(connection, std::move(answer));
    });
  });
}

void HttpServer::Serving::Send(const Shared& connection, HttpAnswer answer) {
  if (answers_bytes_ > 0 && answers_bytes_ + answer.body.size() > options_.limits.answers)
    answer = InWords(503, "Too many read at once. Try again.");
  answers_bytes_ += answer.body.size();
  connection->answer = std::move(answer);
  connection->stage = Stage::kWaits;
  LimitTime(connection, connection->answer.delay + options_.limits.answer +
                            kAnswerPerMb * (connection->answer.body.size() >> 20));
  if (connection->answer.delay.count() == 0) return SendNow(connection);
  connection->pause.expires_after(connection->answer.delay);
  connection->pause.async_wait([this, connection](const Failing& error) {
    if (!error && !connection->is_cut) SendNow(connection);
  });
}

std::string HttpServer::Serving::HeadOf(const HttpAnswer& answer) const {
  const auto reason = http::obsolete_reason(static_cast<http::status>(answer.status));
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + " " + std::string(reason) + "\r\n";
  const auto add = [&head](const std::string& name, const std::string& value) {
    head += name + ": " + value + "\r\n";
  };
  add("Content-Type", answer.type);
  add("Content-Length", std::to_string(answer.body.size()));
  add("Connection", "close");
  for (const auto& [name, value] : answer.headers) add(name, value);
  for (const auto& [name, value] : options_.headers) {
    const bool is_set = std::any_of(answer.headers.begin(), answer.headers.end(),
                                    [&name = name](const auto& each) { return each.first == name; });
    if (!is_set) add(name, value);
  }
  return head + "\r\n";
}

void HttpServer::Serving::SendNow(const Shared& connection) {
  connection->stage = Stage::kWrites;
  connection->head = HeadOf(connection->answer);
  const std::array<asio::const_buffer, 2> all = {
      asio::buffer(connection->head),
      connection->is_head ? asio::const_buffer() : asio::buffer(connection->answer.body)};
  asio::async_write(connection->socket, all, [this, connection](const Failing& error, std::size_t) {
    if (connection->is_cut) return;
    if (error) return Cut(connection);
    Leave(connection);
  });
}

/// Reads what nobody wants, until the peer goes away.
void HttpServer::Serving::Drop(const Shared& connection) {
  connection->socket.async_read_some(asio::buffer(connection->dropped),
                                     [this, connection](const Failing& error, std::size_t size) {
                                       if (connection->is_cut) return;
                                       if (error || size > connection->droppable) return Cut(connection);
                                       connection->droppable -= size;
                                       Drop(connection);
                                     });
}

void HttpServer::Serving::Leave(const Shared& connection) {
  if (connection->is_whole) return Cut(connection);
  connection->stage = Stage::kLeaves;
  Failing ignored;
  connection->socket.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  LimitTime(connection, kFarewell);
  Drop(connection);
}

HttpServer::HttpServer(const HttpOptions& options, HttpHandler handler)
    : serving_(std::make_unique<Serving>(options, std::move(handler))) {}

HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const { return serving_->port(); }

}  // namespace dispersa
