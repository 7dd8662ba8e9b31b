// The one text of a tree: sorted keys, shortest numbers, no comments. Equal content gives equal bytes.
#pragma once

#include <string>

#include "core/input/input_node.h"

namespace dispersa {

/// YAML text of a map. It parses to a tree with the same canonical text.
std::string CanonicalText(const InputNode& map);

}  // namespace dispersa
