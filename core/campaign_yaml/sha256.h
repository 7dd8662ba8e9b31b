// SHA-256 as text: ids of campaigns and flights, digests of named files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dispersa {

/// 64 lower-case hexadecimal digits. Throws std::runtime_error if OpenSSL cannot compute it.
std::string Sha256Hex(std::string_view bytes);
/// The same of a file, also of a large one; empty: it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& file);
/// Whether the text can be such a digest.
bool IsSha256Hex(std::string_view text);

}  // namespace dispersa
