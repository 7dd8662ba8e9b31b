#include "core/flight/history.h"

#include <algorithm>

#include "core/flight/history_columns.h"

namespace dispersa {

const std::vector<std::string>& HistoryColumns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> list = KinematicColumnNames();
    const std::vector<std::string>& launcher = LauncherColumnNames();
    list.insert(list.end(), launcher.begin(), launcher.end());
    return list;
  }();
  return columns;
}

int FindHistoryColumn(const std::string& name) {
  const auto& columns = HistoryColumns();
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

}  // namespace dispersa
