#include "core/input/printable.h"

#include <array>
#include <cstdio>

namespace dispersa {

std::string Printable(const std::string& text, std::size_t limit) {
  std::string clean;
  for (const char c : text) {
    if (clean.size() >= limit) return clean + "...";
    if (c >= ' ' && c <= '~') {
      clean += c;
    } else {
      std::array<char, 5> code{};
      std::snprintf(code.data(), code.size(), "\\x%02x",
                    static_cast<unsigned>(static_cast<unsigned char>(c)));
      clean += code.data();
    }
  }
  return clean;
}

}  // namespace dispersa
