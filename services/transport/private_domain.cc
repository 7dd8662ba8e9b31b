#include "services/transport/private_domain.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <string>

#include "services/transport/network.h"
#include "services/transport/udp_port.h"

namespace dispersa {
namespace {

constexpr int kFirst = 40;
constexpr int kCount = 60;

// An abstract socket name: unique within the network namespace, as ports are, and gone with its process.
bool Reserve(int socket, int domain) {
  const std::string name = "dispersa/domain/" + std::to_string(domain);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0;
}

}  // namespace

PrivateDomain::PrivateDomain() {
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw NetworkError(std::string("no socket: ") + std::strerror(errno));
  for (int i = 0; i < kCount; ++i) {
    domain_ = kFirst + (getpid() + i) % kCount;
    if (IsUdpPortFree("127.0.0.1", CoordinatorPort(domain_)) && Reserve(socket_, domain_)) return;
  }
  close(socket_);
  throw NetworkError("all private domains (40 to 99) are in use on this machine");
}

PrivateDomain::~PrivateDomain() { close(socket_); }

}  // namespace dispersa
