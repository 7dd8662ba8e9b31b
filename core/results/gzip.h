// Texts compressed as gzip does it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dispersa {

/// Without name and time, so that the same text gives the same bytes.
std::string Gzip(std::string_view text);
/// The text of these bytes; none if they are damaged.
std::optional<std::string> Gunzip(std::string_view bytes);

}  // namespace dispersa
