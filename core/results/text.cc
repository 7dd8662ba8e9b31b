#include "core/results/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace dispersa {

void AppendShortest(double value, std::string& text) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0);
  text.append(buffer.data(), result.ptr);
}

std::string ShortestText(double value) {
  std::string text;
  AppendShortest(value, text);
  return text;
}

std::string DigitsText(double value, int digits) {
  if (!std::isfinite(value)) return "";
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0,
                                    std::chars_format::general, digits);
  return std::string(buffer.data(), result.ptr);
}

std::string ReadableText(double value) {
  if (!std::isfinite(value)) return "–";
  const double magnitude = std::fabs(value);
  if (magnitude == 0.0) return "0";
  if (magnitude < 1e-4 || magnitude >= 1e9) return fmt::format("{:.3e}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(magnitude)));
  std::string text = fmt::format("{:.{}f}", value, std::clamp(4 - exponent, 0, 7));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

namespace {

/// Of a value and a resolution; what is a multiple of it but for the last bits stays.
double RoundTo(double value, double resolution, Rounding rounding) {
  const double steps = value / resolution;
  const double nearest = std::round(steps);
  if (rounding == Rounding::kNearest || std::fabs(steps - nearest) < 1e-9 * std::max(1.0, std::fabs(steps)))
    return nearest * resolution;
  return (rounding == Rounding::kUp ? std::ceil(steps) : std::floor(steps)) * resolution;
}

/// Whether the rounded value stands otherwise to `against` than the value: beyond it, or beside what it
/// equals.
bool Misplaces(double value, double rounded, double against) {
  if (!std::isfinite(against)) return false;
  if (value == against) return std::fabs(rounded - against) > 1e-14 * std::fabs(against);
  return value < against ? rounded >= against : rounded <= against;
}

/// Decimals that show two digits of the distance between the two; `least` where nothing else asks for more.
int DecimalsBeside(double value, double against, int least) {
  const double distance = std::fabs(value - against);
  if (!std::isfinite(distance) || distance == 0.0) return least;
  return std::max(least, 1 - static_cast<int>(std::floor(std::log10(distance))));
}

std::string WithoutZeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

std::string StatedText(double value) {
  if (!std::isfinite(value)) return "–";
  const double magnitude = std::fabs(value);
  if (magnitude != 0.0 && (magnitude < 1e-4 || magnitude >= 1e9)) return fmt::format("{:.12g}", value);
  const int exponent = magnitude == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(magnitude)));
  return WithoutZeros(fmt::format("{:.{}f}", value + 0.0, std::max(0, 11 - exponent)));
}

std::string RoundedText(double value, Rounding rounding, double against) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const double magnitude = std::fabs(value);
  const int exponent = static_cast<int>(std::floor(std::log10(magnitude)));
  double rounded = value;
  int digits = std::min(16, DecimalsBeside(value, against, 2 - exponent) + exponent + 1);
  for (; digits < 17; ++digits) {
    rounded = RoundTo(value, std::pow(10.0, exponent - digits + 1), rounding);
    if (!Misplaces(value, rounded, against)) break;
  }
  if (magnitude < 1e-4 || magnitude >= 1e9) return fmt::format("{:.{}e}", rounded, digits - 1);
  return WithoutZeros(fmt::format("{:.{}f}", rounded, std::max(0, digits - 1 - exponent)));
}

std::string ScatterText(double value, double deviation) {
  if (!std::isfinite(value)) return "–";
  if (!(deviation > 0.0) || !std::isfinite(deviation)) return ReadableText(value);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(deviation)));
  if (decimals > 6 || std::fabs(value) >= 1e9) return RoundedText(value);
  const double rounded = RoundTo(value, std::pow(10.0, -decimals), Rounding::kNearest);
  return WithoutZeros(FixedText(rounded, std::max(0, decimals)));
}

std::string ShareText(double probability, Rounding rounding, double against) {
  if (!std::isfinite(probability)) return "–";
  const double percent = 100.0 * probability, missing = 100.0 - percent;
  if (percent <= 0.0) return "0 %";
  if (missing <= 0.0) return "100 %";
  if (percent < 0.001 && rounding != Rounding::kDown) return "< 0.001 %";
  int decimals = percent < 99.0 ? 2 - static_cast<int>(std::floor(std::log10(percent)))
                                : std::max(2, static_cast<int>(-std::floor(std::log10(missing))));
  decimals = DecimalsBeside(percent, 100.0 * against, decimals);
  double rounded = percent;
  for (; decimals < 15; ++decimals) {
    rounded = RoundTo(percent, std::pow(10.0, -decimals), rounding);
    if (!Misplaces(percent, rounded, 100.0 * against)) break;
  }
  return WithoutZeros(fmt::format("{:.{}f}", rounded, decimals)) + " %";
}

std::string PValueText(double p) {
  if (!std::isfinite(p)) return "–";
  if (p < 1e-15) return "< 1e-15";
  return p < 1e-4 ? fmt::format("{:.1e}", p) : RoundedText(p);
}

std::string FixedText(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  return text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1) : text;
}

std::string PercentText(double probability) {
  if (!std::isfinite(probability)) return "–";
  std::string digits = fmt::format("{:.5g}", 100.0 * probability);
  if (digits == "100" && probability < 1.0) digits = fmt::format("{:.9g}", 100.0 * probability);
  return digits + " %";
}

std::string CsvField(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string HtmlText(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string ShellWord(const std::string& text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%") ==
          std::string::npos &&
      !text.empty()) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace dispersa
