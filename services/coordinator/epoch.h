// The number of a coordinator's start. Workers tell an older coordinator from a younger one by it.
#pragma once

#include <cstdint>
#include <filesystem>

namespace dispersa {

inline constexpr char kEpochFile[] = "epoch";

/// Microseconds since 1970, never 0. A start after another one has a larger number, unless the clock was set
/// back between them.
std::uint64_t NextEpoch();

/// The number in this file; 0: it cannot be read, or there is none. InputError if it is damaged.
std::uint64_t ReadEpoch(const std::filesystem::path& file);

/// The same, but more than that of the last start on this data directory. The number is stored there, so it
/// also holds for a copy on another host. A failure to store it is logged. InputError if the file is damaged.
/// `by_itself`: the watchdog started this coordinator again. Then it is younger than before, and older than
/// another host that somebody started in its place meanwhile.
std::uint64_t NextEpoch(const std::filesystem::path& data, bool by_itself = false);

}  // namespace dispersa
