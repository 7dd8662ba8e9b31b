// Fast DDS moves on to another port when one is occupied; a fixed port must be checked before.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Whether a UDP socket can be bound there. Empty address: any interface.
bool IsUdpPortFree(const std::string& address, std::uint16_t port);

}  // namespace dispersa
