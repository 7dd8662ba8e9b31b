// JSON of texts that others wrote.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dispersa {

/// Bytes that are not UTF-8, as a campaign's name or an error message may have them, become U+FFFD instead of
/// an exception.
inline std::string DumpAnyText(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace dispersa
