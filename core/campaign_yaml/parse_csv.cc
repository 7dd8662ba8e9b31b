#include "core/campaign_yaml/parse_csv.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/campaign_yaml/text_problems.h"
#include "core/input/map_reader.h"

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
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    std::size_t first = begin;
    std::size_t last = comma;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({std::string(line.substr(first, last - first)), static_cast<int>(first) + 1});
    if (comma == line.size()) return cells;
    begin = comma + 1;
  }
}

// For each wanted column its place in the header; empty after a problem.
std::vector<std::size_t> MatchHeader(const std::vector<Cell>& header, const std::vector<std::string>& columns,
                                     const std::string& allowed, const std::string& file, int line,
                                     std::vector<InputProblem>& problems) {
  const std::size_t before = problems.size();
  std::vector<std::size_t> places;
  for (const std::string& column : columns) {
    const auto found =
        std::find_if(header.begin(), header.end(), [&](const Cell& cell) { return cell.text == column; });
    if (found == header.end()) {
      problems.push_back({file, line, 1, "", "missing column '" + column + "'", allowed});
    }
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (std::find(columns.begin(), columns.end(), header[i].text) == columns.end()) {
      problems.push_back({file, line, header[i].column, "",
                          "unknown column '" + header[i].text + "'" + DidYouMean(header[i].text, columns),
                          allowed});
    } else if (std::find(places.begin(), places.end(), i) == places.end()) {
      problems.push_back(
          {file, line, header[i].column, "", "the column '" + header[i].text + "' is given twice", allowed});
    }
  }
  if (problems.size() > before) places.clear();
  return places;
}

}  // namespace

InputNode ParseCsv(const std::string& text, const std::string& file, const std::vector<std::string>& wanted,
                   std::vector<InputProblem>& problems, const std::vector<std::string>& optional) {
  if (!CheckUtf8(text, file, problems)) return {};
  std::vector<std::string> columns = wanted;
  const std::string allowed = "the columns " + JoinWords(wanted) +
                              (optional.empty() ? "" : ", and " + JoinWords(optional) + " if there is one");
  const std::size_t before = problems.size();
  InputNode place;
  place.file = std::make_shared<const std::string>(file);
  InputNode table = MapAt(place);
  std::optional<std::vector<std::size_t>> places;
  int line_number = 0;
  std::string_view rest = WithoutByteOrderMark(text);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line_number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.starts_with('#')) continue;

    const std::vector<Cell> cells = SplitLine(line);
    if (!places) {
      if (wanted.empty()) {
        for (const Cell& cell : cells) {
          if (std::find(columns.begin(), columns.end(), cell.text) == columns.end())
            columns.push_back(cell.text);
        }
      }
      for (const std::string& column : optional)
        if (std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) { return cell.text == column; }))
          columns.push_back(column);
      places = MatchHeader(cells, columns, wanted.empty() ? "the columns " + JoinWords(columns) : allowed,
                           file, line_number, problems);
      if (places->empty()) return {};
      place.line = line_number;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        place.column = cells[(*places)[c]].column;
        SetMember(table, columns[c], ListAt(place));
      }
      continue;
    }
    if (cells.size() != columns.size()) {
      problems.push_back({file, line_number, 1, "", "the row has " + std::to_string(cells.size()) + " cells",
                          std::to_string(columns.size()) + ", as the header"});
      continue;
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Cell& cell = cells[(*places)[c]];
      InputNode value = ScalarAt(place, cell.text);
      value.line = line_number;
      value.column = cell.column;
      table.members[c].value.items.push_back(std::move(value));
    }
  }
  if (!places)
    problems.push_back({file, 1, 1, "", "the table is empty",
                        columns.empty() ? "a line with the names of its columns" : allowed});
  if (problems.size() > before) return {};
  return table;
}

}  // namespace dispersa
