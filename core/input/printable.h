// Text of others, made fit to be shown.
#pragma once

#include <string>

namespace dispersa {

/// Printable ASCII alone: any other byte as \xNN, so that no text steers a terminal or breaks a line of a
/// log. What is longer than `limit` is cut, with "..." behind it.
std::string Printable(const std::string& text, std::size_t limit = 200);

}  // namespace dispersa
