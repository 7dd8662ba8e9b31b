#include "services/cli/terminal.h"

#include <sys/ioctl.h>

namespace dispersa {

std::size_t TerminalWidth(int file, std::size_t otherwise) {
  winsize size{};
  return ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : otherwise;
}

std::string FitColumns(const std::string& text, std::size_t columns) {
  const auto begins_character = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xc0) != 0x80;
  };
  if (columns == 0) return "";
  std::size_t used = 0, cut = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!begins_character(at)) continue;
    if (++used == columns) cut = at;
    if (used > columns) return text.substr(0, cut) + "…";
  }
  return text;
}

}  // namespace dispersa
