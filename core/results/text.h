// Numbers and strings as written in the files of a result folder.
#pragma once

#include <string>
#include <string_view>

namespace dispersa {

/// The shortest decimal that reads back as the same double. Empty if not finite; -0 becomes 0.
std::string ShortestText(double value);
/// For people: five significant digits, without an exponent between 1e-4 and 1e9. "–" if not finite.
std::string ReadableText(double value);
/// `decimals` decimals, never "-0.000".
std::string FixedText(double value, int decimals);
/// A probability in per cent, with five digits, or with more if needed to show that it is not 1: 0.9973 is
/// "99.73 %".
std::string PercentText(double probability);
/// One field of a CSV line, quoted by the rules of RFC 4180 if it holds a comma, a quote or a line break.
std::string CsvField(std::string_view text);
/// Text inside an HTML element or a double-quoted attribute.
std::string HtmlText(std::string_view text);
/// One word of a POSIX shell, for commands that a reader copies. In single quotes if needed.
std::string ShellWord(const std::string& text);

}  // namespace dispersa
