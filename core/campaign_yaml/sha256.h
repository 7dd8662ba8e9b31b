// SHA-256 as text: ids of campaigns and flights, digests of named files.
#pragma once

#include <string>
#include <string_view>

namespace dispersa {

/// 64 lower-case hexadecimal digits. Throws std::runtime_error if OpenSSL cannot compute it.
std::string Sha256Hex(std::string_view bytes);
/// Whether the text can be such a digest.
bool IsSha256Hex(std::string_view text);

}  // namespace dispersa
