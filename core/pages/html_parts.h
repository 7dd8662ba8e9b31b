// Pieces of a page: tables, figures, and the style sheet.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

/// A table whose columns are text (left) or numbers (right). Cells are HTML already. Without any title it has
/// no head.
class HtmlTable {
 public:
  struct Column {
    std::string title;
    bool number = false;
    bool names_row = false;  ///< its cells are heads of their rows
  };

  explicit HtmlTable(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// "!Stage|#thrust, kN|Motor": titles of columns; ! is before that of the names of rows, # before those of
  /// numbers.
  explicit HtmlTable(std::string_view titles);

  void Row(const std::vector<std::string>& cells, std::string_view row_class = "");
  /// One cell over the whole width.
  void Wide(const std::string& cell, std::string_view row_class);
  /// The table as HTML.
  std::string Html(std::string_view table_class = "") const;

 private:
  std::vector<Column> columns_;
  std::string rows_;
};

/// A chart with what to see in it. `style`: "wide" over the page, "screen" not in print.
std::string Figure(const std::string& svg, const std::string& caption_html, std::string_view style = "");

/// "pass", "fail", "inconclusive", "not_evidence", "post hoc", "incomplete" as a coloured label that is also
/// readable without colour.
std::string VerdictBadge(std::string_view verdict);

/// A number in the head of a page, above its label.
std::string Tile(const std::string& value, const std::string& label);
std::string Code(const std::string& text);
/// The name of an input in the campaign file, and its column.
std::string InputNames(const std::string& key, const std::string& column);
/// "12.5 deg"; without a unit the number alone.
std::string WithUnit(double value, const std::string& unit);

/// Everything of a page before its contents. In print `footer` stands below each page, beside its number.
std::string PageHead(const std::string& title, const std::string& footer, const std::string& more_style = "");

}  // namespace dispersa
