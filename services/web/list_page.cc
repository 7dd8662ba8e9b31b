#include <fmt/format.h>

#include <algorithm>

#include "core/pages/html_parts.h"
#include "core/results/text.h"
#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

std::string PageLinks(const std::string& search, std::size_t page, std::size_t pages) {
  if (pages < 2) return "";
  const auto link = [&](std::size_t to, const char* text) {
    return fmt::format("<a href=\"/?q={}&amp;page={}\">{}</a>", UrlText(search), to, text);
  };
  return fmt::format("<nav class=\"pages\" aria-label=\"Pages\">{}<span>page {} of {}</span>{}</nav>\n",
                     page > 1 ? link(page - 1, "← newer") : "", page, pages,
                     page < pages ? link(page + 1, "older →") : "");
}

std::string Progress(const CampaignRow& row) {
  if (row.has_ended) return fmt::format("{}", row.done);
  return fmt::format("{} of {} <progress max=\"{}\" value=\"{}\"></progress>", row.done, row.cases, row.cases,
                     row.done);
}

}  // namespace

std::string ListPage(const CampaignIndex& index, const std::string& search, std::size_t page) {
  const std::vector<const CampaignRow*> found = index.Search(search);
  const std::size_t pages = std::max<std::size_t>(1, (found.size() + kRowsOfPage - 1) / kRowsOfPage);
  page = std::clamp<std::size_t>(page, 1, pages);
  HtmlTable table(
      "<span class=\"hidden\">Compare</span>|Campaign|Verdict|Owner|#Cases|#Attempt|Labels|Launched, UTC");
  const std::size_t first = (page - 1) * kRowsOfPage, last = std::min(found.size(), first + kRowsOfPage);
  for (std::size_t i = first; i < last; ++i) {
    const CampaignRow& row = *found[i];
    table.Row({fmt::format("<input type=\"checkbox\" name=\"id\" value=\"{}\" aria-label=\"Compare {}\">",
                           row.id, HtmlText(row.name)),
               NameOf(row), StandingOfRow(row), HtmlText(row.owner), Progress(row),
               row.attempts == 0 ? "" : std::to_string(row.attempts), LabelsOf(row),
               TimeText(row.launched_unix_s)});
  }
  std::string main =
      fmt::format("<h1>Campaigns</h1>\n<p class=\"soft\">{}</p>\n",
                  search.empty() ? fmt::format("{} {}, the last launched first.", index.rows().size(),
                                               index.rows().size() == 1 ? "campaign" : "campaigns")
                                 : fmt::format("{} of {} campaigns have “{}”. <a href=\"/\">Show all</a>",
                                               found.size(), index.rows().size(), HtmlText(search)));
  if (found.empty()) return Frame("Campaigns", main, search);
  main +=
      "<form class=\"campaigns\" action=\"/difference\">\n<p class=\"act\"><button>Compare two</button> "
      "<span "
      "class=\"soft\">Mark two campaigns.</span></p>\n" +
      table.Html("list") + "</form>\n" + PageLinks(search, page, pages);
  return Frame("Campaigns", main, search);
}

}  // namespace dispersa
