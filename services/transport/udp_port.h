// A check that a fixed port is free: Fast DDS moves on to another port if one is occupied.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Whether a UDP socket can be bound there. Empty address: any interface.
bool IsUdpPortFree(const std::string& address, std::uint16_t port);

}  // namespace dispersa
