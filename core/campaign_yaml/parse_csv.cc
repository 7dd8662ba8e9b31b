#include "core/campaign_yaml/parse_csv.h"

#include <algorithm>
#include <string_view>

#include "core/campaign_yaml/text_problems.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

struct Cell {
  std::string text;
  int column = 1;  // of its first character
};

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

// The comma of the world's one half, the semicolon of the other, whose numbers have decimal commas.
char SeparatorOf(std::string_view header) {
  bool is_quoted = false;
  for (const char c : header) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == ';' && !is_quoted) return ';';
  }
  return ',';
}

// The cells of a line. A cell may be in quotes (RFC 4180); a quote inside is written twice. Returns false
// for a quote that does not end, or goes on beside its end; `cells` then ends with that cell.
bool SplitLine(std::string_view line, char separator, std::vector<Cell>& cells) {
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && IsBlank(line[at])) ++at;
    Cell& cell = cells.emplace_back();
    cell.column = static_cast<int>(at) + 1;
    if (at < line.size() && line[at] == '"') {
      for (++at; at < line.size() && (line[at] != '"' || line.substr(at, 2) == "\"\""); ++at) {
        if (line[at] == '"') ++at;
        cell.text += line[at];
      }
      if (at == line.size()) return false;
      for (++at; at < line.size() && IsBlank(line[at]);) ++at;
      if (at < line.size() && line[at] != separator) return false;
    } else {
      const std::size_t end = std::min(line.find(separator, at), line.size());
      cell.text = line.substr(at, end - at);
      at = end;
    }
    while (!cell.text.empty() && IsBlank(cell.text.back())) cell.text.pop_back();
    if (at == line.size()) return true;
    ++at;
  }
}

// Cells of numbers, by what separates their whole part from the rest.
class DecimalMarks {
 public:
  // With a decimal comma turned into a point. Texts are left as they are.
  std::string Read(const Cell& cell, int line) {
    const std::size_t comma = cell.text.find(',');
    if (comma == std::string::npos) {
      if (cell.text.find('.') != std::string::npos) has_point_ = true;
      return cell.text;
    }
    std::string number = cell.text;
    number[comma] = '.';
    if (number.find(',') != std::string::npos || !ParseNumber(number)) return cell.text;
    if (comma_.text.empty()) comma_ = cell, line_ = line;
    return number;
  }
  void Check(const std::string& file, std::vector<InputProblem>& problems) const {
    if (has_point_ && !comma_.text.empty())
      problems.push_back({file, line_, comma_.column, "",
                          "'" + comma_.text + "' has a decimal comma, and other numbers a decimal point",
                          "one decimal mark in a table"});
  }

 private:
  bool has_point_ = false;
  Cell comma_;  // the first with a decimal comma
  int line_ = 0;
};

}  // namespace

InputNode ParseCsv(const std::string& text, const std::string& file, std::vector<InputProblem>& problems) {
  if (!CheckUtf8(text, file, problems)) return {};
  if (WithoutByteOrderMark(text).starts_with('{')) {
    problems.push_back({file, 1, 1, "", "the file is JSON", "a table with a line of names"});
    return {};
  }
  const std::size_t before = problems.size();
  InputNode place;
  place.file = std::make_shared<const std::string>(file);
  InputNode table = MapAt(place);
  table.is_table = true;
  place.line = 0;
  std::string_view rest = WithoutByteOrderMark(text);
  char separator = ',';
  DecimalMarks marks;
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

    if (table.members.empty()) separator = SeparatorOf(line);
    std::vector<Cell> cells;
    if (!SplitLine(line, separator, cells)) {
      problems.push_back({file, place.line, cells.back().column, "",
                          "the quotes of this cell do not end with it",
                          "\"text\", with a quote inside written twice"});
      continue;
    }
    if (table.members.empty()) {
      table.line = place.line;
      for (const Cell& cell : cells) {
        place.column = cell.column;
        table.members.push_back({cell.text, place.line, place.column, ListAt(place)});
      }
    } else if (cells.size() != table.members.size()) {
      problems.push_back({file, place.line, 1, "", "the row has " + std::to_string(cells.size()) + " cells",
                          std::to_string(table.members.size()) + ", as the header" +
                              (separator == ',' && cells.size() > table.members.size()
                                   ? ". Decimal commas need ';' between cells"
                                   : "")});
    } else {
      for (std::size_t c = 0; c < cells.size(); ++c) {
        place.column = cells[c].column;
        table.members[c].value.items.push_back(
            ScalarAt(place, separator == ';' ? marks.Read(cells[c], place.line) : cells[c].text));
      }
    }
    place.line += breaks;
  }
  marks.Check(file, problems);
  if (table.members.empty())
    problems.push_back({file, 1, 1, "", "the table is empty", "a line with the names of its columns"});
  if (problems.size() > before) return {};
  return table;
}

}  // namespace dispersa
