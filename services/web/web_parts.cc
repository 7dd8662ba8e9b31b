#include "services/web/web_parts.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/pages/html_parts.h"
#include "core/results/text.h"
#include "services/web/pages.h"

namespace dispersa {

std::string Frame(const std::string& title, const std::string& main, const std::string& search,
                  const std::string& head) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{} – dispersa</title>\n<link "
      "rel=\"stylesheet\" "
      "href=\"/style.css\">\n<link rel=\"icon\" href=\"data:,\">\n<script src=\"/script.js\" "
      "defer></script>\n{}"
      "</head>\n<body>\n<header class=\"top\"><a class=\"home\" href=\"/\">dispersa</a><nav><a "
      "href=\"/\">Campaigns</a><a href=\"/trend\">Trends</a></nav><form class=\"search\" action=\"/\" "
      "role=\"search\"><input type=\"search\" name=\"q\" value=\"{}\" placeholder=\"name, owner, id, label, "
      "verdict\" aria-label=\"Search "
      "campaigns\"><button>Search</button></form></header>\n<main>\n{}</main>\n</body>\n"
      "</html>\n",
      HtmlText(title), head, HtmlText(search), main);
}

std::string LinkTo(const CampaignRow& row) { return "/campaign/" + row.id; }

std::string NameOf(const CampaignRow& row) {
  return fmt::format("<a href=\"{}\">{}</a> <code class=\"soft\">{}</code>", LinkTo(row), HtmlText(row.name),
                     row.id.substr(0, 8));
}

std::string StandingOfRow(const CampaignRow& row) {
  if (!row.verdict.empty() && row.state == "done") return VerdictBadge(HtmlText(row.verdict));
  return fmt::format("<span class=\"state {0}\">{0}</span>", HtmlText(row.state));
}

std::string LabelsOf(const CampaignRow& row) {
  std::string html;
  for (const std::string& label : row.labels)
    html += fmt::format("<a class=\"label\" href=\"/?q={}\">{}</a> ", UrlText(label), HtmlText(label));
  return html;
}

std::string TimeText(std::int64_t unix_s) {
  return unix_s == 0 ? "–" : fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(unix_s)));
}

std::string BytesText(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value >= 1e9) return fmt::format("{:.1f} GB", value / 1e9);
  if (value >= 1e6) return fmt::format("{:.1f} MB", value / 1e6);
  return fmt::format("{:.0f} kB", value / 1e3);
}

std::string LocalPath(const std::string& next) {
  const bool is_local =
      next.starts_with('/') && !next.starts_with("//") &&
      std::all_of(next.begin(), next.end(), [](char c) { return c > ' ' && c <= '~' && c != '\\'; });
  return is_local ? next : "/";
}

std::string UrlText(const std::string& text) {
  std::string url;
  for (const char c : text) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          c == '-' || c == '_' || c == '.';
    if (is_plain) {
      url += c;
    } else {
      url += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
  }
  return url;
}

std::string LoginPage(const std::string& next, bool was_wrong) {
  return Frame(
      "Sign in",
      fmt::format("<h1>Sign in</h1>\n{}<form class=\"login\" method=\"post\" action=\"/login\"><input "
                  "type=\"hidden\" name=\"next\" value=\"{}\"><label>Token <input type=\"password\" "
                  "name=\"token\" autocomplete=\"current-password\" required autofocus></label><button>Sign "
                  "in</button></form>\n<p class=\"soft\">The token is in the file that the coordinator was "
                  "started with (<code>--web-token</code>). Ask its operator.</p>\n",
                  was_wrong ? "<p class=\"wrong\">This is not the token.</p>\n" : "", HtmlText(next)));
}

std::string ErrorPage(const std::string& title, const std::string& text) {
  return Frame(title, "<h1>" + HtmlText(title) + "</h1>\n<p>" + HtmlText(text) +
                          "</p>\n<p><a href=\"/\">All campaigns</a></p>\n");
}

}  // namespace dispersa
