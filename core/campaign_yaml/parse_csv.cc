#include "core/campaign_yaml/parse_csv.h"

#include <algorithm>
#include <string_view>

#include "core/campaign_yaml/text_problems.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

struct Cell {
  std::string text;
  int column = 1;  // of its first character
};

std::vector<Cell> SplitLine(std::string_view line) {
  std::vector<Cell> cells;
  std::size_t begin = 0;
  while (true) {
    std::size_t comma = begin;
    for (bool is_quoted = false; comma < line.size() && (is_quoted || line[comma] != ','); ++comma)
      if (line[comma] == '"') is_quoted = !is_quoted;
    std::size_t first = begin;
    std::size_t last = comma;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({std::string(line.substr(first, last - first)), static_cast<int>(first) + 1});
    if (comma == line.size()) return cells;
    begin = comma + 1;
  }
}

}  // namespace

InputNode ParseCsv(const std::string& text, const std::string& file, std::vector<InputProblem>& problems) {
  if (!CheckUtf8(text, file, problems)) return {};
  const std::size_t before = problems.size();
  InputNode place;
  place.file = std::make_shared<const std::string>(file);
  InputNode table = MapAt(place);
  table.is_table = true;
  place.line = 0;
  std::string_view rest = WithoutByteOrderMark(text);
  while (!rest.empty()) {
    // A quoted cell, such as the reason of a lost flight, may have line breaks.
    std::size_t end = 0;
    int breaks = 0;
    for (bool is_quoted = false; end < rest.size() && (is_quoted || rest[end] != '\n'); ++end) {
      if (rest[end] == '"' && !rest.starts_with('#')) is_quoted = !is_quoted;
      if (rest[end] == '\n') ++breaks;
    }
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++place.line;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.starts_with('#')) continue;

    const std::vector<Cell> cells = SplitLine(line);
    if (table.members.empty()) {
      table.line = place.line;
      for (const Cell& cell : cells) {
        place.column = cell.column;
        table.members.push_back({cell.text, place.line, place.column, ListAt(place)});
      }
    } else if (cells.size() != table.members.size()) {
      problems.push_back({file, place.line, 1, "", "the row has " + std::to_string(cells.size()) + " cells",
                          std::to_string(table.members.size()) + ", as the header"});
    } else {
      for (std::size_t c = 0; c < cells.size(); ++c) {
        place.column = cells[c].column;
        table.members[c].value.items.push_back(ScalarAt(place, cells[c].text));
      }
    }
    place.line += breaks;
  }
  if (table.members.empty())
    problems.push_back({file, 1, 1, "", "the table is empty", "a line with the names of its columns"});
  if (problems.size() > before) return {};
  return table;
}

}  // namespace dispersa
