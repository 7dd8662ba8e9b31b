// Numbers as text: shortest form that reads back to the same bits, independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dispersa {

/// The number that the whole text is, decimal, with or without a leading sign. "nan", "inf" and YAML's
/// ".nan" and ".inf" count as numbers, as does what overflows (infinite); -0 becomes 0.
std::optional<double> ParseNumber(std::string_view text);
/// The whole text as an unsigned decimal integer.
std::optional<std::uint64_t> ParseInteger(std::string_view text);

/// Shortest text that reads back to the same bits; whole numbers below 2^53 without an exponent; 0 for -0.
std::string FormatNumber(double value);

/// Six significant digits, for messages.
std::string FormatRounded(double value);

/// Text x such that x * scale is `value` to the bit, the shortest one; where no double x is, the nearest.
/// FormatScaled(ParseNumber(FormatScaled(v, s)) * s, s) is always FormatScaled(v, s).
std::string FormatScaled(double value, double scale);
/// Radians in degrees, so.
std::string FormatDegrees(double radians);

}  // namespace dispersa
