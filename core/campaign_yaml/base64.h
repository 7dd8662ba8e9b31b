// Bytes as text: RFC 4648, with padding, on one line.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dispersa {

std::string Base64(std::string_view bytes);
/// None where the text is not of that form.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace dispersa
