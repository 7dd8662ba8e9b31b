// Numbers as text: shortest form that reads back to the same bits, independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dispersa {

/// The number that is the whole text: decimal, with or without a leading sign. "nan", "inf", YAML's ".nan"
/// and ".inf", and texts that overflow (infinite) count as numbers. -0 becomes 0.
std::optional<double> ParseNumber(std::string_view text);
/// The whole text as an unsigned decimal integer.
std::optional<std::uint64_t> ParseInteger(std::string_view text);

/// Shortest text that reads back to the same bits. Whole numbers below 2^53 have no exponent. -0 becomes 0.
std::string FormatNumber(double value);

/// Six significant digits, for messages.
std::string FormatRounded(double value);

/// Shortest text x such that x * scale is `value` to the bit. If no double x is, the nearest.
/// FormatScaled(ParseNumber(FormatScaled(v, s)) * s, s) is always FormatScaled(v, s).
std::string FormatScaled(double value, double scale);
/// Radians in degrees, so.
std::string FormatDegrees(double radians);

}  // namespace dispersa
