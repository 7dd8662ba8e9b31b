#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// "2026-01-31T12:00:00.123Z"
std::string UtcNow();
/// "2026-01-31T12:00:00Z"
std::string UtcText(std::int64_t unix_s);

}  // namespace dispersa
