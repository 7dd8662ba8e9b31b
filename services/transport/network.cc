#include "services/transport/network.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <random>
#include <sstream>

namespace dispersa {

Peer ParsePeer(const std::string& text, int domain) {
  const std::size_t colon = text.rfind(':');
  if (text.find(':') != colon)
    throw NetworkError("peer '" + text +
                       "' is an IPv6 address, allowed: an IPv4 address or a host name, with :PORT if the "
                       "port is not the usual one");
  Peer peer{text.substr(0, colon), CoordinatorPort(domain)};
  if (colon != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, peer.port);
    if (error != std::errc() || rest != end || peer.port == 0) {
      throw NetworkError("peer '" + text + "': not HOST:PORT with a port from 1 to 65535");
    }
  }
  if (peer.host.empty()) throw NetworkError("peer '" + text + "': the host is missing");
  return peer;
}

std::vector<Peer> ParsePeers(const std::string& text, int domain) {
  std::vector<Peer> peers;
  std::istringstream all(text + ",");
  for (std::string one; std::getline(all, one, ',');) peers.push_back(ParsePeer(one, domain));
  return peers;
}

std::uint16_t PortOf(int domain, int offset) {
  return static_cast<std::uint16_t>(7400 + 250 * domain + offset);
}

std::uint16_t CoordinatorPort(int domain) { return PortOf(domain, 5); }

std::uint16_t StatusPort(int domain) { return static_cast<std::uint16_t>(CoordinatorPort(domain) + 1); }

std::string MakeUuid() {
  std::random_device device;
  std::array<char, 33> text{};
  for (int i = 0; i < 4; ++i) {
    std::snprintf(text.data() + 8 * i, 9, "%08x", static_cast<unsigned>(device()));
  }
  return std::string(text.data(), 32);
}

}  // namespace dispersa
