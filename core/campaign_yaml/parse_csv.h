// CSV tables to trees: a map from column name to the list of its cells.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Comma-separated; lines that begin with '#' and empty lines do not count; the first other line names the
/// columns, in any order. Which there must be, and what their cells are, is for the reader of the map to say.
/// A table of another form is a problem and an absent node (without file), which the readers ignore.
InputNode ParseCsv(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

}  // namespace dispersa
