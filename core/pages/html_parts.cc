#include "core/pages/html_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/pages/embedded.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

/// A string of CSS: what could end it, or the style sheet around it, as an escape.
std::string CssString(std::string_view text) {
  std::string css = "\"";
  for (const char c : text) {
    const bool plain = c != '"' && c != '\\' && c != '<' && static_cast<unsigned char>(c) >= 0x20;
    css += plain ? std::string(1, c) : fmt::format("\\{:06x}", static_cast<unsigned char>(c));
  }
  return css + "\"";
}

}  // namespace

std::string Tile(const std::string& value, const std::string& label) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, label);
}

std::string Code(const std::string& text) { return "<code>" + HtmlText(text) + "</code>"; }

std::string InputNames(const std::string& key, const std::string& column) {
  if (key.empty() || key == column) return Code(column);
  return Code(key) + " <span class=\"soft\">" + Code(column) + "</span>";
}

std::string WithUnit(double value, const std::string& unit) {
  return ReadableText(value) + (unit.empty() ? "" : " " + unit);
}

HtmlTable::HtmlTable(std::string_view titles) {
  for (bool more = true; more;) {
    const std::size_t end = titles.find('|');
    std::string_view title = titles.substr(0, end);
    more = end != std::string_view::npos;
    if (more) titles.remove_prefix(end + 1);
    const auto has = [&title](char mark) {
      const bool marked = title.starts_with(mark);
      title.remove_prefix(marked);
      return marked;
    };
    const bool names_row = has('!'), is_number = has('#');
    columns_.push_back({std::string(title), is_number, names_row});
  }
}

void HtmlTable::Row(const std::vector<std::string>& cells, std::string_view row_class) {
  rows_ += row_class.empty() ? std::string("<tr>") : fmt::format("<tr class=\"{}\">", row_class);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* style = columns_[i].number ? " class=\"n\"" : "";
    rows_ += columns_[i].names_row ? fmt::format("<th scope=\"row\"{}>{}</th>", style, cells[i])
                                   : fmt::format("<td{}>{}</td>", style, cells[i]);
  }
  rows_ += "</tr>\n";
}

void HtmlTable::Wide(const std::string& cell, std::string_view row_class) {
  rows_ += fmt::format("<tr class=\"{}\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n", row_class,
                       columns_.size(), cell);
}

std::string HtmlTable::Html(std::string_view table_class) const {
  std::string head;
  bool titled = false;
  for (const Column& column : columns_) {
    const char* style = column.number ? " class=\"n\"" : "";
    titled = titled || !column.title.empty();
    head += column.title.empty() ? fmt::format("<td{}></td>", style)
                                 : fmt::format("<th scope=\"col\"{}>{}</th>", style, column.title);
  }
  head = titled ? "<thead><tr>" + head + "</tr></thead>\n" : "";
  return fmt::format("<div class=\"scroll\" tabindex=\"0\"><table{}>{}<tbody>\n{}</tbody></table></div>\n",
                     table_class.empty() ? "" : fmt::format(" class=\"{}\"", table_class), head, rows_);
}

std::string Figure(const std::string& svg, const std::string& caption_html, std::string_view style) {
  return fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                     style.empty() ? "" : fmt::format(" class=\"{}\"", style), svg, caption_html);
}

std::string VerdictBadge(std::string_view verdict) {
  const std::string_view sign = verdict == "pass"           ? "✓"
                                : verdict == "fail"         ? "✗"
                                : verdict == "inconclusive" ? "?"
                                : verdict == "study"        ? "◇"
                                : verdict == "incomplete"   ? "…"
                                                            : "⊘";
  // "not evidence" is of the class "not-evidence".
  std::string name(verdict), spoken(verdict);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '_'; }, '-');
  std::replace(spoken.begin(), spoken.end(), '_', ' ');
  return fmt::format("<span class=\"badge {}\">{} {}</span>", name, sign, spoken);
}

std::string PageHead(const std::string& title, const std::string& footer, const std::string& more_style) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{} – dispersa</title>\n<style>{}{}\n"
      "@page {{ @bottom-left {{ content: {}; }} @bottom-right {{ content: counter(page) \" / \" "
      "counter(pages); }} }}"
      "\n</style>\n</head>\n<body>\n",
      HtmlText(title), StyleSheet(), more_style, CssString(footer));
}

}  // namespace dispersa
