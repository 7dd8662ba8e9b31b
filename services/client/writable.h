// Whether results can be written where they are wanted, asked before hours are spent on them.
#pragma once

#include <filesystem>
#include <string>

namespace dispersa {

/// A file that can be made or replaced there; nothing stays there of the question. An empty path and "-"
/// ask nothing. Throws InputError, which begins with the option's name.
void RequireWritableFile(const std::string& option, const std::filesystem::path& path);

/// A folder that is there or can be made, to write files into.
void RequireWritableFolder(const std::string& option, const std::filesystem::path& path);

}  // namespace dispersa
