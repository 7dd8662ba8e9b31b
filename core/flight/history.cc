#include "core/flight/history.h"

#include <algorithm>
#include <numeric>

#include "core/flight/history_columns.h"

namespace dispersa {

const std::vector<std::string>& HistoryColumns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> list = KinematicColumnNames();
    for (const LauncherColumn& column : LauncherColumns()) list.emplace_back(column.name);
    return list;
  }();
  return columns;
}

std::vector<int> HistoryColumnsUnder(const AutopilotConfig& autopilot) {
  std::vector<int> positions(KinematicColumnNames().size());
  std::iota(positions.begin(), positions.end(), 0);
  int position = static_cast<int>(positions.size());
  for (const LauncherColumn& column : LauncherColumns()) {
    // For one-axis laws only pitch is shown. A plug-in shows the same columns of all axes.
    const bool is_foreign = column.of_law == &LawInfo::foreign;
    if (column.of_law == nullptr ||
        (is_foreign ? PluginAxes(autopilot) != 0 : InfoOf(autopilot.pitch.law).*column.of_law))
      positions.push_back(position);
    ++position;
  }
  return positions;
}

int FindHistoryColumn(const std::string& name) {
  const auto& columns = HistoryColumns();
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

}  // namespace dispersa
