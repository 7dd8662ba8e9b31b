// A file that is based on another one of its kind says only what differs.
#pragma once

#include <string>
#include <vector>

#include "core/input/field_reader.h"

namespace dispersa {

/// Writes the file at `node` out: keys that it lacks come from its base, without those that it leaves out. A
/// base may have a base. Values stay where they stand. After a problem, which is recorded, the node is
/// absent. A node of another schema stays as it is. `path` is the node's own in its file.
void WriteOut(InputNode& node, const BaseKeys& keys, const std::string& path,
              std::vector<InputProblem>& problems, FileSource* files);

/// Whether a file is of this kind; a map that stands inside another file need not say so. Records a problem
/// if not.
bool HasSchema(const InputNode& node, const std::string& path, const std::string& schema,
               std::vector<InputProblem>& problems);

}  // namespace dispersa
