#include "core/campaign_yaml/text_problems.h"

#include <algorithm>

namespace dispersa {
namespace {

// Bytes of the character that begins at `at`, by RFC 3629; 0: no character does.
std::size_t CharacterBytes(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
  };
  const unsigned first = byte(0);
  const std::size_t bytes = first < 0x80                    ? 1
                            : first >= 0xC2 && first < 0xE0 ? 2
                            : first >= 0xE0 && first < 0xF0 ? 3
                            : first >= 0xF0 && first < 0xF5 ? 4
                                                            : 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // Longer than need be, halves of a surrogate pair, beyond the last plane.
  if (first == 0xE0 && byte(1) < 0xA0) return 0;
  if (first == 0xED && byte(1) >= 0xA0) return 0;
  if (first == 0xF0 && byte(1) < 0x90) return 0;
  if (first == 0xF4 && byte(1) >= 0x90) return 0;
  return bytes;
}

}  // namespace

bool CheckUtf8(const std::string& text, const std::string& file, std::vector<InputProblem>& problems) {
  int line = 1;
  int column = 1;
  for (std::size_t at = 0; at < text.size();) {
    // A text of single bytes in UTF-16 is UTF-8 with a byte 0 beside each.
    const std::size_t bytes = text[at] == '\0' ? 0 : CharacterBytes(text, at);
    if (bytes == 0) {
      constexpr char kDigits[] = "0123456789ABCDEF";
      const auto byte = static_cast<unsigned char>(text[at]);
      problems.push_back({file, line, column, "",
                          std::string("the byte 0x") + kDigits[byte >> 4] + kDigits[byte & 15] +
                              " is no UTF-8: the file is in another encoding, such as " +
                              (byte == 0 || (at == 0 && byte >= 0xFE) ? "UTF-16" : "Latin-1"),
                          "text in UTF-8"});
      return false;
    }
    ++column;
    if (text[at] == '\n') {
      ++line;
      column = 1;
    }
    at += bytes;
  }
  return true;
}

bool CheckIndentation(const std::string& text, const std::string& file, int last_line,
                      std::vector<InputProblem>& problems) {
  std::size_t begin = 0;
  for (int line = 1; line <= last_line && begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::size_t at = begin;
    while (at < end && text[at] == ' ') ++at;
    // A line of nothing, or of a comment, is indented by nothing.
    const std::size_t first = std::min(text.find_first_not_of(" \t\r", at), end);
    if (at < end && text[at] == '\t' && first < end && text[first] != '#') {
      problems.push_back(
          {file, line, static_cast<int>(at - begin) + 1, "", "a tab indents the line", "spaces"});
      return false;
    }
    begin = end + 1;
  }
  return true;
}

std::string_view WithoutByteOrderMark(const std::string& text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  std::string_view rest = text;
  if (rest.substr(0, kMark.size()) == kMark) rest.remove_prefix(kMark.size());
  return rest;
}

std::vector<std::string_view> LinesOf(std::string_view text, std::size_t most) {
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < most) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace dispersa
