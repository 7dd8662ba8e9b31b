// Numbers and texts in the JSON files of results.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace dispersa {

/// Undefined is null, and -0 is 0.
inline nlohmann::ordered_json Number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value + 0.0) : nlohmann::ordered_json(nullptr);
}

/// No text is null.
inline nlohmann::ordered_json TextOrNull(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

}  // namespace dispersa
