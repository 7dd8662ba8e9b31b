// CSV tables to trees: a map from column name to the list of its cells.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// Parses a text of cells apart by commas, or by semicolons if its header has one; a number may then have a
/// decimal comma. Cells may be in quotes, within a line. Lines that begin with '#' and empty lines do not
/// count. The first other line names the columns, in any order. The reader of the map checks the columns and
/// the cells. A table of another form is a problem and gives an absent node (without file), which the readers
/// ignore.
InputNode ParseCsv(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

}  // namespace dispersa
