// CSV tables to trees: a map from column name to the list of its cells.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Comma-separated; lines that begin with '#' and empty lines do not count; the first other line names the
/// columns, which must be exactly those `wanted`, in any order; any if that is empty; `optional` ones may be
/// there besides. Cells are not checked here. A table of another form is a problem and an absent node
/// (without file), which the readers ignore.
InputNode ParseCsv(const std::string& text, const std::string& file, const std::vector<std::string>& wanted,
                   std::vector<InputProblem>& problems, const std::vector<std::string>& optional = {});

}  // namespace dispersa
