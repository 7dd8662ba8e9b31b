#include "services/transport/udp_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "services/log/log.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

/// The port that is bound, which is another one if `port` is 0; none: it is not free.
std::optional<std::uint16_t> TryPort(const std::string& address, std::uint16_t port) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(port);
  where.sin_addr.s_addr = INADDR_ANY;
  if (!address.empty() && inet_pton(AF_INET, address.c_str(), &where.sin_addr) != 1) return std::nullopt;
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return std::nullopt;
  socklen_t size = sizeof where;
  const bool is_free = bind(probe, reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0 &&
                       getsockname(probe, reinterpret_cast<sockaddr*>(&where), &size) == 0;
  const int error = errno;
  close(probe);
  errno = error;
  return is_free ? std::optional(ntohs(where.sin_port)) : std::nullopt;
}

}  // namespace

bool IsUdpPortFree(const std::string& address, std::uint16_t port) {
  return TryPort(address, port).has_value();
}

std::uint16_t FreeUdpPort(const std::string& address, std::uint16_t first, std::uint16_t last) {
  const int count = (last - first) / 2 + 1;
  for (int i = 0; i < count; ++i) {
    const auto port = static_cast<std::uint16_t>(first + 2 * ((getpid() + i) % count));
    if (IsUdpPortFree(address, port)) return port;
  }
  const auto other = TryPort(address, 0);
  if (!other) throw NetworkError(std::string("no UDP port is free: ") + std::strerror(errno));
  LogWarning("UDP ports {} to {} are all taken; port {} is used, which a firewall may not let pass", first,
             last, *other);
  return *other;
}

}  // namespace dispersa
