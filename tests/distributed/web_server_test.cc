// Who may read the web application, over real sockets on loopback.
#include "services/web/web_server.h"

#include <sys/stat.h>

#include "core/input/input_error.h"
#include "http_client.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::web_server_test {

constexpr char kToken[] = "0123456789abcdef";

class WebServerTest : public testing::Test {
 protected:
  void Start(const std::string& token = "", bool behind_tls = false,
             std::chrono::seconds session = std::chrono::hours(12)) {
    server_.reset();
    port_ = FreePort();
    server_ = std::make_unique<WebServer>(
        WebOptions{{"127.0.0.1", port_}, token, behind_tls, session},
        [](const std::string&, const std::string& name) {
          return name == "report.html" ? std::optional<std::string>("<p>report</p>") : std::nullopt;
        });
    auto row = std::make_shared<CampaignRow>();
    row->id = kId;
    row->name = "table3";
    row->state = "done";
    row->has_ended = true;
    row->verdict = "pass";
    server_->Set(std::make_shared<CampaignIndex>(std::vector<CampaignIndex::Row>{row}));
  }
  /// `more`: headers, each with its end of line.
  std::string Get(const std::string& path, const std::string& more = "",
                  const std::string& host = "localhost") {
    return AskHttp(
        port_, "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "Connection: close\r\n\r\n");
  }
  std::string Post(const std::string& path, const std::string& body, const std::string& more = "") {
    return AskHttp(port_, "POST " + path + " HTTP/1.1\r\nHost: localhost\r\n" + more +
                              "Content-Type: application/x-www-form-urlencoded\r\nContent-Length: " +
                              std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" + body);
  }

  const std::string kId = std::string(64, 'b');
  std::uint16_t port_ = 0;
  std::unique_ptr<WebServer> server_;
};

TEST_F(WebServerTest, OnLoopbackItsOwnUserReads) {
  Start();
  EXPECT_THAT(Get("/"), HasSubstr("table3"));
  EXPECT_THAT(Get("/campaign/" + kId), HasSubstr("Open the report"));
  EXPECT_THAT(Get("/campaign/bb"), HasSubstr("Location: /campaign/" + kId)) << "the permanent address";
  EXPECT_THAT(Get("/trend"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(Get("/difference?id=b&id=bb"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(Get("/difference?id=b"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/style.css"), HasSubstr("text/css"));
  EXPECT_THAT(Get("/script.js"), HasSubstr("refresh"));
  EXPECT_THAT(Get("/campaign/cc"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/campaign/" + kId + "/campaign.yaml"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/", "", "evil.example"), StartsWith("HTTP/1.1 403")) << "a name that points here";
}

TEST_F(WebServerTest, OneHostThatIsThisMachineAndNoOther) {
  Start();
  const auto ask = [&](const std::string& hosts) {
    return AskHttp(port_, "GET / HTTP/1.1\r\n" + hosts + "Connection: close\r\n\r\n");
  };
  for (const std::string host : {"127.0.0.1", "localhost", "localhost:9"})
    EXPECT_THAT(ask("Host: " + host + "\r\n"), StartsWith("HTTP/1.1 200 ")) << host;
  for (const std::string hosts :
       {"Host: rebound.example\r\n", "Host: 127.0.0.1.example\r\n", "Host: \r\n", "",
        "Host: 127.0.0.1\r\nHost: rebound.example\r\n", "Host: rebound.example\r\nHost: 127.0.0.1\r\n",
        "Host: 127.0.0.1\r\nHost: 127.0.0.1\r\n"}) {
    EXPECT_THAT(ask(hosts), StartsWith("HTTP/1.1 403 ")) << hosts;
    EXPECT_THAT(ask(hosts), Not(HasSubstr("table3"))) << hosts;
  }
}

TEST_F(WebServerTest, NothingIsChangedThroughIt) {
  Start();
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH"}) {
    const std::string answer =
        AskHttp(port_, std::string(method) + " /campaign/" + kId +
                           " HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 404")) << method;
  }
}

// It is made of texts of clients: it reads nothing of the other pages, which have no script in themselves.
TEST_F(WebServerTest, AReportIsInASandbox) {
  Start();
  const std::string report = Get("/campaign/" + kId + "/report");
  EXPECT_THAT(report, HasSubstr("<p>report</p>"));
  EXPECT_THAT(report, HasSubstr("Content-Security-Policy: sandbox allow-scripts;"));
  EXPECT_THAT(report, Not(HasSubstr("script-src 'self'")));
  EXPECT_THAT(Get("/"), HasSubstr("script-src 'self'"));
}

TEST_F(WebServerTest, WithATokenWhoeverLacksItIsAskedForIt) {
  Start(kToken);
  EXPECT_THAT(Get("/campaign/" + kId), HasSubstr("Location: /login?next=%2Fcampaign%2F" + kId));
  for (const char* path : {"/", "/trend", "/script.js"})
    EXPECT_THAT(Get(path), Not(HasSubstr("table3"))) << path;
  EXPECT_THAT(Get("/campaign/" + kId + "?part=1"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(Get("/", "Authorization: Bearer 0123456789abcdeX\r\n"), StartsWith("HTTP/1.1 302"));
  EXPECT_THAT(Get("/", "Cookie: dispersa=0123456789abcdef\r\n"), StartsWith("HTTP/1.1 302"))
      << "the token is no cookie";
  EXPECT_THAT(Get("/", std::string("Authorization: Bearer ") + kToken + "\r\n"), HasSubstr("table3"));
  const std::string wrong = Post("/login", "next=%2F&token=wrong");
  EXPECT_THAT(wrong, StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(wrong, Not(HasSubstr("Set-Cookie")));
  const std::string right = Post("/login", std::string("next=%2Ftrend&token=") + kToken);
  EXPECT_THAT(right, StartsWith("HTTP/1.1 303"));
  EXPECT_THAT(right, HasSubstr("Location: /trend"));
  EXPECT_THAT(right, HasSubstr("; HttpOnly; SameSite=Lax"));
  const std::size_t at = right.find("dispersa=");
  const std::string cookie = right.substr(at, right.find(';', at) - at);
  EXPECT_THAT(Get("/", "Cookie: other=1; " + cookie + "\r\n"), HasSubstr("table3"));
  for (const char* next :
       {"%2F%2Fevil.example", "%2F%09%2Fevil.example", "https%3A%2F%2Fevil.example", "%2F%5Cevil.example"})
    EXPECT_THAT(Post("/login", std::string("next=") + next + "&token=" + kToken),
                HasSubstr("Location: /\r\n"))
        << next;
}

TEST_F(WebServerTest, ASessionEnds) {
  Start(kToken, false, std::chrono::seconds(2));
  const std::string right = Post("/login", std::string("next=%2F&token=") + kToken);
  EXPECT_THAT(right, HasSubstr("; Max-Age=2"));
  const std::size_t at = right.find("dispersa=");
  const std::string cookie = right.substr(at, right.find(';', at) - at);
  EXPECT_THAT(Get("/", "Cookie: " + cookie + "\r\n"), HasSubstr("table3"));
  const std::size_t dot = cookie.find('.');
  const std::string longer = "dispersa=9999999999" + cookie.substr(dot);
  EXPECT_THAT(Get("/", "Cookie: " + longer + "\r\n"), StartsWith("HTTP/1.1 302")) << "its end is signed";
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  EXPECT_THAT(Get("/", "Cookie: " + cookie + "\r\n"), StartsWith("HTTP/1.1 302"));
}

TEST_F(WebServerTest, BehindAProxyOnlyWhatCameOverTls) {
  Start(kToken, true);
  const std::string token = std::string("Authorization: Bearer ") + kToken + "\r\n";
  EXPECT_THAT(Get("/", token), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Get("/", token + "X-Forwarded-Proto: http\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Get("/", token + "X-Forwarded-Proto: https\r\n", "dispersa.example"), HasSubstr("table3"));
  EXPECT_THAT(Post("/login", std::string("next=%2F&token=") + kToken, "X-Forwarded-Proto: https\r\n"),
              HasSubstr("; Secure"));
}

TEST(WebOptionsTest, BeyondLoopbackATokenAndTlsAreNeeded) {
  const auto why = [](const char* host, const char* token, bool behind_tls) {
    return WhyTooOpen({{host, 80}, token, behind_tls});
  };
  const std::string too_open =
      "--web beyond 127.0.0.1 needs --web-token FILE and --web-behind-tls: a proxy before it that speaks TLS";
  EXPECT_EQ(why("127.0.0.1", "", false), "");
  EXPECT_EQ(why("127.0.0.1", kToken, false), "");
  EXPECT_EQ(why("0.0.0.0", "", false), too_open);
  EXPECT_EQ(why("0.0.0.0", kToken, false), too_open) << "plain HTTP";
  EXPECT_EQ(why("192.0.2.1", "", true), "--web-behind-tls needs --web-token FILE");
  EXPECT_EQ(why("192.0.2.1", kToken, true), "");
}

TEST(WebOptionsTest, ATokenIsLongAndNobodyElses) {
  const TemporaryFolder folder;
  const std::string file = (folder / "token").string();
  const auto error = [&]() -> std::string {
    try {
      return "token " + ReadWebToken(file);
    } catch (const InputError& problem) {
      return problem.what();
    }
  };
  EXPECT_THAT(error(), HasSubstr("no token can be read"));
  std::ofstream(file) << kToken << "\nmore";
  chmod(file.c_str(), 0640);
  EXPECT_EQ(error(), std::string("token ") + kToken);
  chmod(file.c_str(), 0644);
  EXPECT_THAT(error(), HasSubstr("other users of this machine can use it"));
  std::ofstream(file) << "short";
  chmod(file.c_str(), 0600);
  EXPECT_THAT(error(), HasSubstr("the token is too short"));
}

}  // namespace dispersa::web_server_test
