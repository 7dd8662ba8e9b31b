// Where the HTTP servers of a coordinator listen.
#include "services/http/http_address.h"

#include "tests/test.h"

namespace dispersa::http_address_test {

TEST(HttpAddress, IsAPortOrAnAddressAndAPort) {
  HttpAddress address;
  EXPECT_TRUE(ReadHttpAddress("9464", &address));
  EXPECT_EQ(address.host, "127.0.0.1");
  EXPECT_EQ(address.port, 9464);
  EXPECT_TRUE(IsOnLoopback(address));
  EXPECT_TRUE(ReadHttpAddress("0.0.0.0:65535", &address));
  EXPECT_EQ(address.host, "0.0.0.0");
  EXPECT_EQ(address.port, 65535);
  EXPECT_FALSE(IsOnLoopback(address));
  for (const char* text : {"", "0", "65536", "-1", "94 64", "9464x", ":9464", "host:9464", "1.2.3:9464",
                           "1.2.3.4:", "::1:9464", "127.0.0.1.example:80", "+80"})
    EXPECT_FALSE(ReadHttpAddress(text, &address)) << text;
}

}  // namespace dispersa::http_address_test
