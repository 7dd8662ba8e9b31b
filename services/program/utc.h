#pragma once

#include <string>

namespace dispersa {

/// "2026-01-31T12:00:00.123Z"
std::string UtcNow();

}  // namespace dispersa
