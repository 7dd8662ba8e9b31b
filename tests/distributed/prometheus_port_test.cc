// The port of the metrics: what a scraper gets, and what others get.
#include "services/coordinator/prometheus_port.h"

#include <unistd.h>

#include "http_client.h"
#include "services/transport/network.h"
#include "tests/test.h"

namespace dispersa::prometheus_port_test {

std::string Get(std::uint16_t port, const std::string& path) {
  return AskHttp(port, "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
}

TEST(PrometheusPort, AnswersWithTheLatestText) {
  const std::uint16_t number = FreePort();
  PrometheusPort port({"127.0.0.1", number});
  port.Set("dispersa_workers 1\n");
  port.Set("dispersa_workers 2\n");
  for (const char* path : {"/metrics", "/"}) {
    const std::string answer = Get(number, path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
    EXPECT_THAT(answer, EndsWith("\r\n\r\ndispersa_workers 2\n"));
  }
}

TEST(PrometheusPort, AnswersNothingElse) {
  const std::uint16_t number = FreePort();
  PrometheusPort port({"127.0.0.1", number});
  port.Set("dispersa_workers 1\n");
  EXPECT_THAT(Get(number, "/else"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(AskHttp(number, "POST /metrics HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n"),
              StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(AskHttp(number, "nonsense\r\n\r\n"), Not(HasSubstr("dispersa_workers")));
}

TEST(PrometheusPort, ListensOnTheChosenAddressAlone) {
  const std::uint16_t number = FreePort();
  const PrometheusPort port({"127.0.0.2", number});
  PrometheusPort other({"127.0.0.1", number});  // of another address the same port is free
  other.Set("dispersa_workers 1\n");
  EXPECT_THAT(Get(number, "/metrics"), HasSubstr("dispersa_workers 1"));
  EXPECT_THAT(
      [&] {
        const PrometheusPort elsewhere({"192.0.2.77", FreePort()});
      },
      testing::ThrowsMessage<NetworkError>(HasSubstr(" of 192.0.2.77: Cannot assign requested address")));
}

TEST(PrometheusPort, APortThatIsTakenIsSaid) {
  const std::uint16_t number = FreePort();
  const PrometheusPort port({"127.0.0.1", number});
  EXPECT_THAT(
      [&] {
        const PrometheusPort second({"127.0.0.1", number});
      },
      testing::ThrowsMessage<NetworkError>("metrics: port " + std::to_string(number) +
                                           " of 127.0.0.1: Address already in use"));
}

}  // namespace dispersa::prometheus_port_test
