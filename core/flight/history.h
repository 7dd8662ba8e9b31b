// Time history of one flight: rows at the output step and at every event.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dispersa {

struct AutopilotConfig;

/// Column names with units, in their fixed order, beginning with time_s.
const std::vector<std::string>& HistoryColumns();
/// Positions of those that flights under an autopilot have: some are of one law alone.
std::vector<int> HistoryColumnsUnder(const AutopilotConfig& autopilot);
/// Position of a column, or -1.
int FindHistoryColumn(const std::string& name);

/// Rows of HistoryColumns().size() doubles each, row by row. NaN is undefined (empty in CSV).
struct History {
  double step_s = 0.1;         ///< output step
  std::vector<double> values;  ///< shape (rows, columns)

  std::size_t rows() const { return values.size() / HistoryColumns().size(); }
  double at(std::size_t row, int column) const { return values[row * HistoryColumns().size() + column]; }
};

}  // namespace dispersa
