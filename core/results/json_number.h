// Numbers in the JSON files of results.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace dispersa {

/// Undefined is null, and -0 is 0.
inline nlohmann::ordered_json Number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value + 0.0) : nlohmann::ordered_json(nullptr);
}

}  // namespace dispersa
