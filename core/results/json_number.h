// Numbers and texts in the JSON files of results.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

namespace dispersa {

/// Undefined is null, and -0 is 0.
inline nlohmann::ordered_json Number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value + 0.0) : nlohmann::ordered_json(nullptr);
}

/// No value is null.
template <typename T>
nlohmann::ordered_json OrNull(const std::optional<T>& value) {
  if (!value) return nullptr;
  if constexpr (std::is_same_v<T, double>) {
    return Number(*value);
  } else {
    return *value;
  }
}

/// No text is null.
inline nlohmann::ordered_json TextOrNull(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

/// A list with what `to_json` makes of each item.
template <typename Items, typename ToJson>
nlohmann::ordered_json ListOf(const Items& items, ToJson to_json) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& item : items) list.push_back(to_json(item));
  return list;
}

}  // namespace dispersa
