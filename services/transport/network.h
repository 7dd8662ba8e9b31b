// Network options: where coordinator and workers find each other.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/transport/key_folder.h"
#include "services/transport/seal.h"

namespace dispersa {

/// Host name or IPv4 address, and a UDP port.
struct Peer {
  std::string host;
  std::uint16_t port = 0;
};

/// "HOST:PORT", or "HOST" with the coordinator's port in `domain`. Throws NetworkError.
Peer ParsePeer(const std::string& text, int domain);
/// One or more of them, with commas between. Throws NetworkError.
std::vector<Peer> ParsePeers(const std::string& text, int domain);

struct NetworkOptions {
  int domain = 0;       ///< 0 .. 99
  std::string address;  ///< IPv4 address of the only interface to use (empty: all)
  /// Our keys. With keys we speak only to holders of keys of the same authority, and everything is encrypted.
  std::optional<KeyFolder> keys = {};
  /// If set, only participants with the same secret are believed (seal.h).
  std::optional<Secret> secret = {};
};

/// UDP ports of a domain: 7400 + 250 * domain + offset, 0 to 249.
std::uint16_t PortOf(int domain, int offset);
/// Ordinary participants take ports of these offsets: even ones for discovery, odd ones for the rest.
inline constexpr int kFirstPort = 10, kLastPort = 217;
/// The further participants of a coordinator (doors.h): two of these each, if they are free.
inline constexpr int kFirstDoorPort = 218, kLastDoorPort = 249;
/// The fixed port at which the coordinator of a domain is discovered: 7400 + 250 * domain + 5. No other
/// participant takes it or the next one.
std::uint16_t CoordinatorPort(int domain);
/// The port at which the coordinator receives workers' signs of life: CoordinatorPort + 1.
std::uint16_t StatusPort(int domain);

/// 128 random bits: one for each start of a worker.
std::string MakeUuid();

/// The network cannot be used as asked: an occupied port, an unknown host, no such interface.
class NetworkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace dispersa
