// YAML text to a tree: the only user of yaml-cpp.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Parses one document. Not YAML, several documents, duplicate keys, keys that are not text, anchors, aliases
/// and tags are problems; then what could be read is returned, and an absent node (without file), which the
/// readers ignore, if that is nothing.
InputNode ParseYaml(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

/// The whole text of a regular file; false with the reason, as the system words it, if it cannot be read.
bool ReadFile(const std::string& path, std::string* text, std::string* reason);

}  // namespace dispersa
