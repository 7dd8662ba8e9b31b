// Checks, before hours of computing, that the results can be written.
#pragma once

#include <filesystem>
#include <string>

namespace dispersa {

/// Checks that a file can be made or replaced at `path`, and leaves nothing behind. An empty path and "-" are
/// not checked. Throws InputError, which begins with the option's name.
void RequireWritableFile(const std::string& option, const std::filesystem::path& path);

/// A folder that is there or can be made, to write files into.
void RequireWritableFolder(const std::string& option, const std::filesystem::path& path);

}  // namespace dispersa
