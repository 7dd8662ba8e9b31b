// The skeleton of all HTTP servers over real sockets: what it refuses, and what it holds on to.
#include "services/http/http_server.h"

#include "http_client.h"
#include "tests/test.h"

namespace dispersa::http_server_test {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

HttpOptions SomeOptions() {
  HttpOptions options;
  options.limits.request = milliseconds(1000);
  return options;
}

HttpAnswer Echo(const HttpRequest& request) {
  HttpAnswer answer;
  answer.body = request.method + " " + request.path;
  for (const auto& [name, value] : request.parameters) answer.body += " " + name + "=" + value;
  return answer;
}

std::string Head(const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n";
}

std::string Form(const std::string& body) {
  return Head("POST /form", "Content-Type: application/x-www-form-urlencoded\r\nContent-Length: " +
                                std::to_string(body.size()) + "\r\n") +
         body;
}

void Say(int connection, const std::string& text) {
  send(connection, text.data(), text.size(), MSG_NOSIGNAL);
}

TEST(HttpServer, ReadsTargetsAndForms) {
  const HttpServer server(SomeOptions(), Echo);
  const auto ask = [&](const std::string& request) { return AskHttp(server.port(), request); };
  EXPECT_THAT(ask(Head("GET /a%20b?x=1&y=a+%26b&z&=")), EndsWith("\r\n\r\nGET /a b x=1 y=a &b z= ="));
  EXPECT_THAT(ask(Head("GET /a%2")), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(ask(Head("GET /a%")), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(ask(Head("GET /?a=%g0")), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(ask(Head("GET a")), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(ask(Form("a=1&b=%3D")), EndsWith("\r\n\r\nPOST /form a=1 b=="));
  EXPECT_THAT(ask(Head("POST /form",
                       "Content-Type: application/x-www-form-urlencoded\r\n"
                       "Transfer-Encoding: chunked\r\n") +
                  "3\r\na=1\r\n2\r\n&b\r\n0\r\n\r\n"),
              EndsWith("\r\n\r\nPOST /form a=1 b="));
  const std::string head = ask(Head("HEAD /abc"));
  EXPECT_THAT(head, HasSubstr("\r\nContent-Length: 8\r\n"));
  EXPECT_THAT(head, EndsWith("\r\n\r\n"));
  EXPECT_THAT(ask("hello\r\n\r\n"), StartsWith("HTTP/1.1 400 "));
}

// Of the same size whether they come with a length or in chunks.
TEST(HttpServer, HasTotalsForAllThatIsSent) {
  HttpOptions options = SomeOptions();
  options.limits.body = 100;
  options.limits.head = 1000;
  options.limits.request_line = 500;
  const HttpServer server(options, Echo);
  const auto ask = [&](const std::string& request) { return AskHttp(server.port(), request); };
  const auto chunked = [](std::size_t size) {
    std::string text = Head("POST /", "Transfer-Encoding: chunked\r\n");
    for (; size > 0; --size) text += "1\r\na\r\n";
    return text + "0\r\n\r\n";
  };
  EXPECT_THAT(ask(Form("a=" + std::string(98, 'a'))), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(ask(Form("a=" + std::string(99, 'a'))), StartsWith("HTTP/1.1 413 "));
  EXPECT_THAT(ask(chunked(100)), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(ask(chunked(101)), StartsWith("HTTP/1.1 413 "));
  const std::string in_chunks = Head("POST /", "Transfer-Encoding: chunked\r\n");
  EXPECT_THAT(ask(in_chunks + "1;" + std::string(2000, 'a') + "\r\na\r\n0\r\n\r\n"),
              StartsWith("HTTP/1.1 431 "));
  EXPECT_THAT(ask(in_chunks + "0\r\nA: " + std::string(2000, 'a') + "\r\n\r\n"), StartsWith("HTTP/1.1 431 "));
  EXPECT_THAT(ask(Head("GET /" + std::string(499, 'a'))), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(ask(Head("GET /" + std::string(500, 'a'))), StartsWith("HTTP/1.1 414 "));
  EXPECT_THAT(ask(Head("GET /", "A: " + std::string(900, 'a') + "\r\n")), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(ask(Head("GET /", "A: " + std::string(1000, 'a') + "\r\n")), StartsWith("HTTP/1.1 431 "));
}

TEST(HttpServer, ARequestHasItsTimeWhateverComes) {
  const HttpServer server(SomeOptions(), Echo);
  for (const std::string& begin :
       {Head("GET /", "A: b"), Head("POST /", "Content-Length: 9\r\n"), std::string()}) {
    const auto begun = Clock::now();
    const int connection = Connected(server.port());
    Say(connection, begin.substr(0, begin.size() - (begin.starts_with("GET") ? 2 : 0)));
    std::thread drip([connection] {
      for (int i = 0; i < 8; ++i) {
        std::this_thread::sleep_for(milliseconds(200));
        Say(connection, "a");
      }
    });
    const std::string answer = Rest(dup(connection));
    const auto lasted = Clock::now() - begun;
    drip.join();
    close(connection);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 408 ")) << begin;
    EXPECT_GE(lasted, milliseconds(950));
    EXPECT_LT(lasted, milliseconds(1900)) << "a second, and the farewell";
  }
}

TEST(HttpServer, TheOldestThatSaysNothingGivesItsPlace) {
  HttpOptions options = SomeOptions();
  options.limits.request = milliseconds(60000);
  options.limits.connections = options.limits.connections_of_peer = 3;
  const HttpServer server(options, Echo);
  std::vector<int> silent;
  for (int i = 0; i < 3; ++i) silent.push_back(Connected(server.port()));
  EXPECT_THAT(AskHttp(server.port(), Head("GET /")), StartsWith("HTTP/1.1 200 "));
  EXPECT_EQ(Rest(silent[0]), "");
  for (int i = 1; i < 3; ++i) {
    Say(silent[i], Head("GET /"));
    EXPECT_THAT(Rest(silent[i]), StartsWith("HTTP/1.1 200 ")) << i;
  }
}

TEST(HttpServer, WhatIsBeingMadeIsWaitedFor) {
  HttpOptions options = SomeOptions();
  options.limits.connections = options.limits.connections_of_peer = 2;
  std::atomic<bool> go{false};
  const HttpServer server(options, [&](const HttpRequest& request) {
    while (!go) std::this_thread::yield();
    return Echo(request);
  });
  std::vector<int> all;
  for (int i = 0; i < 4; ++i) {
    all.push_back(Connected(server.port()));
    Say(all.back(), Head("GET /"));
  }
  std::this_thread::sleep_for(milliseconds(50));
  go = true;
  for (const int each : all) EXPECT_THAT(Rest(each), StartsWith("HTTP/1.1 200 "));
}

TEST(HttpServer, AnswersThatNobodyReadsAreBounded) {
  HttpOptions options = SomeOptions();
  options.limits.answers = 10 << 20;
  const HttpServer server(options, [](const HttpRequest&) {
    HttpAnswer answer;
    answer.body.assign(9 << 20, 'a');
    return answer;
  });
  const int slow = Connected(server.port());
  Say(slow, Head("GET /"));
  char first = 0;
  recv(slow, &first, 1, 0);
  EXPECT_THAT(AskHttp(server.port(), Head("GET /")), StartsWith("HTTP/1.1 503 "));
  EXPECT_EQ(Rest(slow).size() >> 20, 9U);
  EXPECT_THAT(AskHttp(server.port(), Head("GET /")), StartsWith("HTTP/1.1 200 "));
}

TEST(HttpServer, AFailedPageIsAnAnswer) {
  const HttpServer server(SomeOptions(),
                          [](const HttpRequest&) -> HttpAnswer { throw std::runtime_error("x"); });
  EXPECT_THAT(AskHttp(server.port(), Head("GET /")), StartsWith("HTTP/1.1 500 "));
}

TEST(HttpServer, ItsOwnUserIsOfItsOwn) {
  HttpOptions options = SomeOptions();
  options.owner_alone = true;
  const HttpServer server(options, Echo);
  EXPECT_THAT(AskHttp(server.port(), Head("GET /")), StartsWith("HTTP/1.1 200 "));
}

}  // namespace dispersa::http_server_test
