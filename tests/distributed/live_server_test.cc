// The page of `watch --web` over a real socket, byte by byte: who may read it, and the messages to each
// browser.
#include "services/cli/live_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace dispersa::live_server_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A connection of a browser that says exactly what it is told to.
class Browser {
 public:
  explicit Browser(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(port);
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};  // ample
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0)
      throw std::runtime_error("no connection");
  }
  ~Browser() { close(socket_); }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void Say(const std::string& text) {
    EXPECT_EQ(send(socket_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }
  /// All that comes until `end` does, or until the server closes the connection.
  std::string Hear(const std::string& end = "\1never\1") {
    std::string heard;
    char part[4096];
    while (heard.find(end) == std::string::npos) {
      const ssize_t size = recv(socket_, part, sizeof part, 0);
      if (size <= 0) break;
      heard.append(part, static_cast<std::size_t>(size));
    }
    return heard;
  }

 private:
  int socket_;
};

class LiveServerTest : public testing::Test {
 protected:
  LiveServerTest() : server_(0, "<style>a{}</style><script>f()</script>the page") {
    const std::string url = server_.Url();
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  static std::string Request(const std::string& path, const std::string& hosts = "Host: 127.0.0.1\r\n") {
    return "GET " + path + " HTTP/1.1\r\n" + hosts + "Connection: close\r\n\r\n";
  }
  std::string Get(const std::string& path, const std::string& hosts = "Host: 127.0.0.1\r\n") {
    Browser browser(port_);
    browser.Say(Request(path, hosts));
    return browser.Hear("\n\n\r\n");  // the end of an event, which no other answer has
  }
  /// A browser that follows, and has been sent what is there.
  std::unique_ptr<Browser> Follow(std::string* first = nullptr) {
    auto browser = std::make_unique<Browser>(port_);
    browser->Say(Request("/events"));
    const std::string heard = browser->Hear("\n\n\r\n");
    EXPECT_THAT(heard, HasSubstr("200 OK"));
    if (first != nullptr) *first = heard;
    return browser;
  }

  LiveServer server_;
  std::uint16_t port_ = 0;
};

constexpr char kRefused[] = "This page is at 127.0.0.1 and localhost only.\n";

TEST_F(LiveServerTest, ServesItsPageWithItsPolicy) {
  EXPECT_EQ(server_.Url(), fmt::format("http://127.0.0.1:{}/", port_));
  const std::string page = Get("/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(page, HasSubstr("\r\n\r\n<style>a{}</style><script>f()</script>the page"));
  for (const char* header :
       {"Content-Security-Policy: default-src 'none'; style-src 'sha256-",
        "X-Content-Type-Options: nosniff\r\n", "Cross-Origin-Resource-Policy: same-origin\r\n",
        "Referrer-Policy: no-referrer\r\n", "Cache-Control: no-store\r\n"})
    EXPECT_THAT(page, HasSubstr(header));
  EXPECT_THAT(Get("/else"), StartsWith("HTTP/1.1 404 "));
}

TEST_F(LiveServerTest, OneHostThatIsThisMachineAndNoOther) {
  for (const std::string host : {"127.0.0.1", "localhost", "localhost:9"})
    EXPECT_THAT(Get("/", "Host: " + host + "\r\n"), StartsWith("HTTP/1.1 200 ")) << host;
  for (const std::string hosts :
       {"Host: rebound.example\r\n", "Host: 127.0.0.1.example\r\n", "Host: \r\n", "",
        "Host: 127.0.0.1\r\nHost: rebound.example\r\n", "Host: rebound.example\r\nHost: 127.0.0.1\r\n",
        "Host: 127.0.0.1\r\nHost: 127.0.0.1\r\n"}) {
    for (const char* path : {"/", "/events"}) {
      const std::string answer = Get(path, hosts);
      EXPECT_THAT(answer, StartsWith("HTTP/1.1 403 ")) << hosts;
      EXPECT_THAT(answer, HasSubstr(kRefused)) << hosts;
      EXPECT_THAT(answer, Not(HasSubstr("the page"))) << hosts;
    }
  }
}

TEST_F(LiveServerTest, ABrowserIsSentAllThatIsThereAndThenWhatChanges) {
  server_.Show({{"a", "one"}, {"b", "two"}});
  std::string first;
  const auto browser = Follow(&first);
  EXPECT_THAT(first, HasSubstr("event: show\ndata: {\"a\":\"one\",\"b\":\"two\"}\n\n"));
  server_.Show({{"a", "one"}, {"b", "three"}});
  EXPECT_THAT(browser->Hear("\n\n\r\n"), HasSubstr("event: show\ndata: {\"b\":\"three\"}\n\n"));
  std::string late;
  const auto other = Follow(&late);
  EXPECT_THAT(late, HasSubstr("event: show\ndata: {\"a\":\"one\",\"b\":\"three\"}\n\n"));
}

TEST_F(LiveServerTest, EveryBrowserIsToldTheEnd) {
  server_.Show({{"a", "one"}});
  const auto browser = Follow(), other = Follow();
  server_.Show({{"a", "last"}});
  server_.End();
  for (Browser* each : {browser.get(), other.get()}) {
    const std::string heard = each->Hear();  // the server closes
    EXPECT_THAT(heard, HasSubstr("\"a\":\"last\""));
    EXPECT_THAT(heard, HasSubstr("event: end\ndata:\n\n"));
  }
}

TEST_F(LiveServerTest, SoManyBrowsersAndNoMore) {
  server_.Show({{"a", "one"}});
  std::vector<std::unique_ptr<Browser>> browsers;
  for (int i = 0; i < 32; ++i) browsers.push_back(Follow());
  const std::string refused = Get("/events");
  EXPECT_THAT(refused, StartsWith("HTTP/1.1 503 "));
  EXPECT_THAT(refused, HasSubstr("Too many browsers watch already.\n"));
  EXPECT_THAT(Get("/"), StartsWith("HTTP/1.1 200 "));
  server_.End();  // a server that is destroyed would wait for those that read nothing
}

TEST_F(LiveServerTest, APortIsOneServersAlone) {
  try {
    const LiveServer second(port_, "<style></style><script></script>");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), fmt::format("port {} of 127.0.0.1: Address already in use", port_));
  }
}

}  // namespace
}  // namespace dispersa::live_server_test
