// What others send that is no use, said without letting them fill the log.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Logs a warning about something of `kind` ("datagram", a topic) from `sender`, in words that are made
/// printable. Of one kind at most one a second is logged; the others are counted and told with the next.
/// Thread-safe.
void Complain(const std::string& kind, const std::string& sender, const std::string& what);

/// So many since the start of the process, of all kinds.
std::uint64_t Complaints();

}  // namespace dispersa
