#include "core/results/number_csv.h"

#include <charconv>

#include "core/statistics/summary.h"

namespace dispersa {
namespace {

/// Calls `take` with each cell of the line that begins at `at`. Returns where the next line begins; 0: the
/// line has no end, or `take` returned false.
template <typename Take>
std::size_t EachCell(std::string_view csv, std::size_t at, Take take) {
  for (;;) {
    const std::size_t end = csv.find_first_of(",\n", at);
    if (end == std::string_view::npos || !take(csv.substr(at, end - at))) return 0;
    at = end + 1;
    if (csv[end] == '\n') return at;
  }
}

}  // namespace

std::optional<NumberCsv> ReadNumberCsv(std::string_view csv) {
  NumberCsv table;
  std::size_t at = EachCell(csv, 0, [&](std::string_view cell) {
    table.columns.emplace_back(cell);
    return !cell.empty();
  });
  while (at > 0 && at < csv.size()) {
    std::vector<double>& row = table.rows.emplace_back();
    row.reserve(table.columns.size());
    at = EachCell(csv, at, [&](std::string_view cell) {
      double& value = row.emplace_back(kUndefined);
      const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      return read.ptr == cell.data() + cell.size() && (cell.empty() || read.ec == std::errc());
    });
    if (row.size() != table.columns.size()) return std::nullopt;
  }
  if (at == 0) return std::nullopt;
  return table;
}

}  // namespace dispersa
