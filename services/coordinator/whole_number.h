// What a command line says of an option that is no whole number in its range.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

namespace dispersa {

/// A case's number has 32 bits.
inline constexpr std::uint64_t kMostCases = 4294967295;

/// Why a text is no whole number from 1 to `most`; empty if it is one. For an option's check().
inline std::string WholeNumberProblem(const std::string& text, std::uint64_t most = kMostCases) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && stopped == end && value >= 1 && value <= most) return "";
  const auto digits = std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  const bool is_whole =
      digits > 0 && (static_cast<std::size_t>(digits) == text.size() ||
                     (static_cast<std::size_t>(digits) + 1 == text.size() && text[0] == '-'));
  return "'" + text + (is_whole ? "' is out of range" : "' is not a whole number") +
         ", allowed: a whole number from 1 to " + std::to_string(most);
}

inline std::string CaseCountProblem(const std::string& text) { return WholeNumberProblem(text); }

}  // namespace dispersa
