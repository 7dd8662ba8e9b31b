#include "services/http/http_address.h"

#include <arpa/inet.h>

#include <charconv>

namespace dispersa {

bool ReadHttpAddress(const std::string& text, HttpAddress* address) {
  const std::size_t colon = text.rfind(':');
  const std::string host = colon == std::string::npos ? HttpAddress().host : text.substr(0, colon);
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  in_addr parsed{};
  if (inet_pton(AF_INET, host.c_str(), &parsed) != 1) return false;
  std::uint16_t number = 0;
  const char* const end = port.data() + port.size();
  const auto [stopped, error] = std::from_chars(port.data(), end, number);
  if (error != std::errc() || stopped != end || number == 0) return false;
  *address = {host, number};
  return true;
}

bool IsOnLoopback(const HttpAddress& address) { return address.host.starts_with("127."); }

}  // namespace dispersa
