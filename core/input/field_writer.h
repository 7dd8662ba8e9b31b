// Writes structs as YAML, by their descriptions.
#pragma once

#include <string>
#include <vector>

#include "core/input/fields.h"

namespace dispersa {

/// How a file is laid out, by its keys.
struct FileLayout {
  std::vector<std::string> on_one_line = {};  ///< maps, else each of their keys has a line
  std::vector<std::string> always = {};       ///< keys that are written where their value is the default, too
  const char* length_unit = "m";              ///< other quantities are in the first unit of their dimension
  bool quotes_all_texts = false;              ///< else where YAML needs it
};

/// A number is the shortest text that reads back to the same bits. A key with its default value is left out.
/// Of several alternatives, the one with `is_so` is written, else the last one if it has no condition.
std::string WriteFields(const FileLayout& layout, const Fields::Part& describe);

}  // namespace dispersa
