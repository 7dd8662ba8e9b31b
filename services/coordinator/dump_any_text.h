// JSON text of strings that may not be UTF-8.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dispersa {

/// Replaces bytes that are not UTF-8 by U+FFFD, where dump() would throw. A campaign's name or an error
/// message may contain such bytes.
inline std::string DumpAnyText(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace dispersa
