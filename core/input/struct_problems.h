// The place in a tree of a field of the struct that was decoded from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/input/input_node.h"
#include "core/input/read_value.h"

namespace dispersa {

/// The node of a field's path, e.g. "stages[1].gimbal.limit_rad", or the last node on the way that exists.
/// `found_path` receives its path with the keys as the file spells them (limit_deg).
const InputNode& FindField(const InputNode& node, const std::string& field_path, std::string* found_path);

/// Whether two keys differ in the unit alone: altitude_m and altitude_km.
bool IsInAnotherUnit(std::string_view a, std::string_view b);

/// Records what the Problems() of a struct found (path, message, allowed) at the places of the values. `path`
/// is the node's.
template <typename StructProblem>
void AddStructProblems(const std::vector<StructProblem>& found, const InputNode& node,
                       const std::string& path, std::vector<InputProblem>& problems) {
  for (const StructProblem& problem : found) {
    std::string found_path;
    const InputNode& at = FindField(node, problem.path, &found_path);
    AddProblem(problems, at, path.empty() || found_path.empty() ? path + found_path : path + "." + found_path,
               problem.message, problem.allowed);
  }
}

}  // namespace dispersa
