#include "core/input/number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/math/constants.h"

namespace dispersa {

std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  const bool negative = text.starts_with('-');
  const std::string_view magnitude = negative ? text.substr(1) : text;
  const double infinity = std::numeric_limits<double>::infinity();
  if (magnitude == ".inf" || magnitude == ".Inf" || magnitude == ".INF")
    return negative ? -infinity : infinity;
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::numeric_limits<double>::quiet_NaN();

  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  // Underflow is reported like overflow; neither is a number that anyone means.
  if (error == std::errc::result_out_of_range) return negative ? -infinity : infinity;
  return value + 0.0;
}

std::optional<std::uint64_t> ParseInteger(std::string_view text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error != std::errc()) return std::nullopt;
  return value;
}

std::string FormatNumber(double value) {
  std::array<char, 32> buffer;
  char* first = buffer.data();
  char* last = first + buffer.size();
  constexpr double kExactIntegers = 9007199254740992.0;  // 2^53
  const bool whole = std::fabs(value) < kExactIntegers && value == std::floor(value);
  const auto result = whole ? std::to_chars(first, last, static_cast<std::int64_t>(value))
                            : std::to_chars(first, last, value);
  return std::string(first, result.ptr);
}

std::string FormatRounded(double value) {
  std::array<char, 32> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6);
  return std::string(buffer.data(), result.ptr);
}

std::string FormatScaled(double value, double scale) {
  const double nearest = value / scale;
  std::string best;
  // x * scale and value / scale both round, so the bits may come from a neighbour of the quotient. A few
  // neighbours are enough: two roundings are less than two units in the last place.
  double candidate = nearest;
  for (int i = 0; i < 3; ++i) candidate = std::nextafter(candidate, -std::numeric_limits<double>::infinity());
  for (int i = -3; i <= 3; ++i) {
    if (candidate * scale == value) {
      std::string text = FormatNumber(candidate);
      if (best.empty() || text.size() < best.size()) best = std::move(text);
    }
    candidate = std::nextafter(candidate, std::numeric_limits<double>::infinity());
  }
  return best.empty() ? FormatNumber(nearest) : best;
}

std::string FormatDegrees(double radians) { return FormatScaled(radians, kRadPerDeg); }

}  // namespace dispersa
