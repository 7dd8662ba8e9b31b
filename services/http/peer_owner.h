// Whose process is at the other end of a connection within this machine.
#pragma once

#include <netinet/in.h>
#include <sys/types.h>

#include <optional>

namespace dispersa {

/// The user whose process opened the connection from `peer` to `own`, by the kernel's table of sockets
/// (sock_diag(7)). None: it is closed, came from another machine or network namespace, or the kernel does not
/// say.
std::optional<uid_t> PeerOwner(const sockaddr_in& own, const sockaddr_in& peer);

}  // namespace dispersa
