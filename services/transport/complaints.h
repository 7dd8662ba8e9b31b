// Warnings about useless data from others. Their rate is limited, so that no sender can fill the log.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Logs a warning about something of `kind` ("datagram", a topic) from `sender`, with all text made
/// printable. At most one warning a second is logged for each kind. The others are counted, and the next
/// warning tells the count. Thread-safe.
void Complain(const std::string& kind, const std::string& sender, const std::string& what);

/// Number of complaints of all kinds since the start of the process.
std::uint64_t Complaints();

}  // namespace dispersa
