// The number of a coordinator's start. Workers tell an older coordinator from a younger one by it.
#pragma once

#include <cstdint>
#include <filesystem>

namespace dispersa {

inline constexpr char kEpochFile[] = "epoch";

/// Microseconds since 1970, never 0. A start after another one has a larger number, unless the clock was set
/// back between them.
std::uint64_t NextEpoch();

/// The same, and in any case more than the last start on this data directory: the number is stored there, so
/// that it also holds for a copy on another host. If it cannot be stored, this is logged.
std::uint64_t NextEpoch(const std::filesystem::path& data);

}  // namespace dispersa
