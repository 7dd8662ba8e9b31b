// Where an HTTP server of a coordinator listens.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

struct HttpAddress {
  std::string host = "127.0.0.1";  ///< IPv4, of one interface, or 0.0.0.0: of all
  std::uint16_t port = 0;
};

/// "PORT", on 127.0.0.1, or "ADDRESS:PORT". False: it is neither.
bool ReadHttpAddress(const std::string& text, HttpAddress* address);
/// Whether this machine alone reaches it.
bool IsOnLoopback(const HttpAddress& address);

}  // namespace dispersa
