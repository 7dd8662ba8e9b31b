// The port for monitors: what scrapers, probes and others get.
#include "services/coordinator/monitor_port.h"

#include <unistd.h>

#include "http_client.h"
#include "services/transport/network.h"
#include "tests/test.h"

namespace dispersa::monitor_port_test {

const Health kNoHealth;

std::string Get(std::uint16_t port, const std::string& path) {
  return AskHttp(port, "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
}

TEST(MonitorPort, AnswersWithTheLatestText) {
  const std::uint16_t number = FreePort();
  MonitorPort port({"127.0.0.1", number}, kNoHealth);
  port.SetFigures("dispersa_workers 1\n");
  port.SetFigures("dispersa_workers 2\n");
  for (const char* path : {"/metrics", "/"}) {
    const std::string answer = Get(number, path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
    EXPECT_THAT(answer, EndsWith("\r\n\r\ndispersa_workers 2\n"));
  }
}

TEST(MonitorPort, AnswersNothingElse) {
  const std::uint16_t number = FreePort();
  MonitorPort port({"127.0.0.1", number}, kNoHealth);
  port.SetFigures("dispersa_workers 1\n");
  EXPECT_THAT(Get(number, "/else"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(AskHttp(number, "POST /metrics HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n"),
              StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(AskHttp(number, "nonsense\r\n\r\n"), Not(HasSubstr("dispersa_workers")));
}

TEST(MonitorPort, ListensOnTheChosenAddressAlone) {
  const std::uint16_t number = FreePort();
  const MonitorPort port({"127.0.0.2", number}, kNoHealth);
  MonitorPort other({"127.0.0.1", number}, kNoHealth);  // of another address the same port is free
  other.SetFigures("dispersa_workers 1\n");
  EXPECT_THAT(Get(number, "/metrics"), HasSubstr("dispersa_workers 1"));
  EXPECT_THAT(
      [&] {
        const MonitorPort elsewhere({"192.0.2.77", FreePort()}, kNoHealth);
      },
      testing::ThrowsMessage<NetworkError>(HasSubstr(" of 192.0.2.77: Cannot assign requested address")));
}

TEST(MonitorPort, APortThatIsTakenIsSaid) {
  const std::uint16_t number = FreePort();
  const MonitorPort port({"127.0.0.1", number}, kNoHealth);
  EXPECT_THAT(
      [&] {
        const MonitorPort second({"127.0.0.1", number}, kNoHealth);
      },
      testing::ThrowsMessage<NetworkError>("metrics: port " + std::to_string(number) +
                                           " of 127.0.0.1: Address already in use"));
}

TEST(MonitorPort, HasNoFiguresBeforeTheFirstOnes) {
  const std::uint16_t number = FreePort();
  const MonitorPort port({"127.0.0.1", number}, kNoHealth);
  const std::string answer = Get(number, "/metrics");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, EndsWith("\r\n\r\nit has no figures yet\n"));
}

// Each probe with both answers: its own, and not the other's.
TEST(MonitorPort, ProbesHearOfTheirOwn) {
  const std::uint16_t number = FreePort();
  Health health;
  const MonitorPort port({"127.0.0.1", number}, health);
  const auto expect = [&](const char* path, const std::string& status, const std::string& words) {
    const std::string answer = Get(number, path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 " + status)) << path;
    EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; charset=utf-8\r\n"));
    EXPECT_THAT(answer, HasSubstr("Cache-Control: no-store\r\n"));
    EXPECT_THAT(answer, EndsWith("\r\n\r\n" + words + "\n")) << path;
  };
  expect("/healthz", "200", "ok");
  expect("/readyz", "503", "it starts and reads its campaigns");
  health.SetPause("");
  expect("/readyz", "503", "it starts and has not heard itself yet");
  health.Beat();
  expect("/readyz", "200", "ok");
  health.SetPause("it shuts down");
  expect("/healthz", "200", "ok");
  expect("/readyz", "503", "it shuts down");
  health.SetPause("");
  health.Beat(Health::Clock::now() - Health::kNoBeat - std::chrono::milliseconds(1500));
  expect("/healthz", "503", "it has not heard itself for 11 s");
  expect("/readyz", "503", "it has not heard itself for 11 s");
}

TEST(MonitorPort, ABeatIsLateAfterItsTime) {
  const Health::Clock::time_point now = Health::Clock::now();
  Health health;
  health.Beat(now);
  EXPECT_EQ(health.WhyDead(now + Health::kNoBeat), "");
  EXPECT_EQ(health.WhyDead(now + Health::kNoBeat + std::chrono::milliseconds(1)),
            "it has not heard itself for 10 s");
}

}  // namespace dispersa::monitor_port_test
