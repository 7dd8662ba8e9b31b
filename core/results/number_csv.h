// CSV files of numbers, as the files of histories/ are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

/// An empty cell is undefined (NaN).
struct NumberCsv {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< a value for each column
};
/// None if the text has something else, or a row with another number of cells than the header.
std::optional<NumberCsv> ReadNumberCsv(std::string_view csv);

}  // namespace dispersa
