#include "core/pages/glossary.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/pages/embedded.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string Trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(' '), to = text.find_last_not_of(' ');
  return from == std::string_view::npos ? "" : std::string(text.substr(from, to - from + 1));
}

/// The rows of two cells of Markdown's tables, without their heads.
std::vector<GlossaryEntry> EntriesOf(std::string_view markdown) {
  std::vector<GlossaryEntry> entries;
  while (!markdown.empty()) {
    const std::size_t end = std::min(markdown.find('\n'), markdown.size());
    const std::string_view line = markdown.substr(0, end);
    markdown.remove_prefix(std::min(end + 1, markdown.size()));
    const std::size_t middle = line.empty() || line[0] != '|' ? std::string_view::npos : line.find('|', 1);
    const std::size_t last = line.rfind('|');
    if (middle == std::string_view::npos || last == middle) continue;
    GlossaryEntry entry = {Trimmed(line.substr(1, middle - 1)),
                           Trimmed(line.substr(middle + 1, last - middle - 1))};
    if (entry.word == "word" || entry.word.starts_with("---")) continue;
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string AnchorOf(std::string_view word) {
  std::string anchor = "term-";
  for (const char c : word) anchor += c == ' ' ? '-' : c == ',' ? '_' : c;
  return anchor;
}

}  // namespace

const std::vector<GlossaryEntry>& Glossary() {
  static const std::vector<GlossaryEntry> entries = EntriesOf(GlossarySource());
  return entries;
}

std::string Term(std::string_view word, std::string_view shown) {
  const std::vector<GlossaryEntry>& all = Glossary();
  if (std::none_of(all.begin(), all.end(), [&](const GlossaryEntry& one) { return one.word == word; }))
    throw std::logic_error("glossary.md has no word '" + std::string(word) + "'");
  return fmt::format("<a class=\"term\" href=\"#{}\">{}</a>", AnchorOf(word), shown.empty() ? word : shown);
}

std::string GlossarySection(std::string_view page, const std::vector<std::string>& more) {
  std::string list;
  for (const GlossaryEntry& entry : Glossary()) {
    const std::string anchor = AnchorOf(entry.word);
    if (page.find("href=\"#" + anchor + "\"") == std::string_view::npos &&
        std::find(more.begin(), more.end(), entry.word) == more.end())
      continue;
    list += fmt::format("<div id=\"{}\"><dt><dfn>{}</dfn></dt><dd>{}</dd></div>\n", anchor,
                        HtmlText(entry.word), HtmlText(entry.meaning));
  }
  if (list.empty()) return "";
  return "<h2 id=\"glossary\">Glossary</h2>\n<dl class=\"glossary\">\n" + list + "</dl>\n";
}

}  // namespace dispersa
