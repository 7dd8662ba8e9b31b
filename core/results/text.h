// Numbers and strings as written in the files of a result folder.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace dispersa {

/// The shortest decimal that reads back as the same double. Empty if not finite; -0 becomes 0.
std::string ShortestText(double value);
/// The same, behind `text`.
void AppendShortest(double value, std::string& text);
/// With so many significant digits at most, otherwise as ShortestText().
std::string DigitsText(double value, int digits);
/// For people: five significant digits, without an exponent between 1e-4 and 1e9. "–" if not finite.
std::string ReadableText(double value);
enum class Rounding { kNearest, kDown, kUp };
/// A number as somebody stated it, a limit for instance: "295.4941". Up to twelve digits.
std::string StatedText(double value);
/// A result for people: three significant digits, "0.225". A bound is rounded to its own side, so that it
/// still holds. Beside a limit (`against`) it has two digits of its distance to the limit at least, and is
/// never rounded to the other side of the limit: "295.494" and "295" are told apart.
std::string RoundedText(double value, Rounding rounding = Rounding::kNearest, double against = std::nan(""));
/// A value of a sample: two digits of the sample's standard deviation; `value` in full where nothing
/// scatters.
std::string ScatterText(double value, double deviation);
/// A probability as a result in per cent: three significant digits, two decimals near 100 %, and one digit of
/// what is missing to 100 % nearer still; "< 0.001 %" below that. 0.99954 rounded down is "99.95 %". Beside
/// another share (`against`) as RoundedText().
std::string ShareText(double probability, Rounding rounding = Rounding::kNearest,
                      double against = std::nan(""));
/// "3.1e-06", "0.0123"; "< 1e-15" where doubles say no more.
std::string PValueText(double p);
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
