// The glossary of the docs site inside a page: a reader without network finds the words that it uses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

struct GlossaryEntry {
  std::string word;     ///< "consumer risk"
  std::string meaning;  ///< plain text
};
/// Of services/docs/pages/glossary.md, in its order.
const std::vector<GlossaryEntry>& Glossary();

/// `shown` (HTML; the word itself if empty) as a link to the word in the page's glossary. A word that is not
/// in the glossary is a programmer's error.
std::string Term(std::string_view word, std::string_view shown = "");

/// A section with the words that `page` links to, and with `more`.
std::string GlossarySection(std::string_view page, const std::vector<std::string>& more = {});

}  // namespace dispersa
