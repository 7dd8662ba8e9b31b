// Fills structs from a tree, by their descriptions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/input/map_reader.h"

namespace dispersa {

/// Reads the map at `node`. Every problem is recorded with its place, and reading goes on; what was read
/// counts only if there is none. `path` is the node's own in its file.
void ReadFields(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                const Fields::Part& describe);

/// The same of a struct with a description.
template <class T>
T ReadStruct(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems) {
  T value;
  ReadFields(node, path, problems, [&](Fields& fields) { Describe(fields, value); });
  return value;
}

}  // namespace dispersa
