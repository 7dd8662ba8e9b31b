// Texts as YAML scalars that read back as themselves.
#pragma once

#include <string>

namespace dispersa {

/// Quoted if it must be.
std::string TextScalar(const std::string& text);
/// Any text in single quotes.
std::string SingleQuoted(const std::string& text);

}  // namespace dispersa
