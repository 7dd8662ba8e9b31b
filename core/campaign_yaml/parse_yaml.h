// YAML text to a tree: the only user of yaml-cpp.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Parses one document. Problems are: text that is not YAML, several documents, duplicate keys, keys that are
/// not text, anchors, aliases and tags. After a problem it returns the part that could be read. If there is
/// none, it returns an absent node (without file), which the readers ignore.
InputNode ParseYaml(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

/// Reads the whole text of a regular file. Returns false, with the system's reason, if it cannot be read.
bool ReadFile(const std::string& path, std::string* text, std::string* reason);

}  // namespace dispersa
