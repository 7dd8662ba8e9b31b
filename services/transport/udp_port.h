// UDP ports that are free. Fast DDS tries a hundred ports if one is occupied, and then hears nothing.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Whether a UDP socket can be bound there. Empty address: any interface.
bool IsUdpPortFree(const std::string& address, std::uint16_t port);

/// A free port of `first`, `first` + 2, ... up to `last`, looked for from another one on in each process:
/// between now and its use another program may take it. If all of them are taken, any free port of
/// the system, with a warning. Throws NetworkError if there is none.
std::uint16_t FreeUdpPort(const std::string& address, std::uint16_t first, std::uint16_t last);

}  // namespace dispersa
