#include "services/cli/live_page.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/analysis/requirement_summary.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/results/metric_catalogue.h"
#include "core/results/text.h"
#include "services/cli/campaign_text.h"
#include "services/cli/progress.h"
#include "services/program/exit_code.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxWorkers = 50;

constexpr char kStyle[] = R"css(
.badge.state { background: var(--soft); color: var(--paper); }
.badge.so-far { background: none; border: 1.5px solid var(--open); color: var(--open); }
.badge.so-far.pass { border-color: var(--pass); color: var(--pass); }
.badge.so-far.fail { border-color: var(--fail); color: var(--fail); }
progress { display: block; width: 100%; height: 14px; margin: 14px 0 0; accent-color: var(--blue); }
.notice { margin: 14px 0 0; padding: 8px 14px; border-left: 4px solid var(--open); background: var(--panel); border-radius: 4px; }
.notice:empty { display: none; }
)css";

constexpr char kScript[] = R"js(
"use strict";
(() => {
  const kSilence_ms = 6000;  // the server says something every 2 s
  const connection = document.getElementById("connection");
  let heard = Date.now(), over = false;
  function connect() {
    const source = new EventSource("events");
    source.addEventListener("show", event => {
      heard = Date.now();
      connection.textContent = "";
      for (const [id, html] of Object.entries(JSON.parse(event.data))) {
        if (id === "title") document.title = html;
        else document.getElementById(id).innerHTML = html;
      }
    });
    source.addEventListener("end", () => {
      over = true;
      source.close();
    });
    source.addEventListener("error", () => {
      if (over) return;
      connection.textContent = "The connection to dispersa watch is lost; this page shows the state before. It connects again by itself.";
      if (source.readyState === EventSource.CLOSED) setTimeout(connect, 2000);
    });
  }
  connect();
  setInterval(() => {
    const silent_ms = Date.now() - heard;
    if (over || silent_ms < kSilence_ms) return;
    connection.textContent = `dispersa watch has sent nothing for ${Math.round(silent_ms / 1000)} s; this page shows the state before.`;
  }, 1000);
})();
)js";

std::string Between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from) + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

/// As a content security policy names a source: 'sha256-...'.
std::string SourceHash(const std::string& text) {
  std::array<unsigned char, 32> digest{};
  EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  std::array<unsigned char, 45> base64{};
  EVP_EncodeBlock(base64.data(), digest.data(), digest.size());
  return fmt::format("'sha256-{}'", reinterpret_cast<const char*>(base64.data()));
}

const char* CodeWords(int code) {
  switch (code) {
    case kExitDone:
      return "every requirement met, or none stated";
    case kExitRequirementFailed:
      return "a requirement failed";
    case kExitInconclusive:
      return "more cases needed";
    case kExitNotEvidence:
      return "not evidence";
    case kExitIncomplete:
      return "incomplete";
    case kExitBadInput:
      return "bad input";
    default:
      return "internal error";
  }
}

std::string Tile(const std::string& value, const std::string& what) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, what);
}

std::string StateWords(const Json& campaign, bool has_workers) {
  if (!campaign.at("problem").is_null()) return campaign.at("problem");
  if (!campaign.at("code").is_null()) {
    const int code = campaign.at("code");
    return fmt::format("Exit code {}: {}.", code, CodeWords(code));
  }
  const std::string state = campaign.at("state");
  if (state == "waiting") return "The campaign waits for its turn.";
  if (state == "reporting") return "All cases have ended; the report is being written.";
  return has_workers ? "Cases are being flown." : "The campaign waits for workers.";
}

std::string ProgressHtml(const Json& campaign, const Json& workers) {
  const auto done = campaign.at("done").get<std::uint64_t>(),
             total = campaign.at("total").get<std::uint64_t>(),
             quarantined = campaign.at("quarantined").get<std::uint64_t>();
  const bool ended = !campaign.at("code").is_null();
  const double rate = campaign.at("rate_per_s");
  std::uint64_t slots = 0;
  for (const Json& worker : workers) slots += worker.at("slots").get<std::uint64_t>();
  std::string html = fmt::format(
      "<div class=\"headline\"><span class=\"badge state\">{}</span><p>{}</p></div>\n"
      "<progress max=\"{}\" value=\"{}\">{}</progress>\n<div class=\"tiles\">",
      HtmlText(campaign.at("state").get<std::string>()), HtmlText(StateWords(campaign, !workers.empty())),
      std::max<std::uint64_t>(total, 1), done + quarantined,
      PercentText(static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(total, 1))));
  html += Tile(fmt::format("{}", done), fmt::format("of {} cases flown", total));
  if (!ended) {
    html += Tile(rate > 0.0 ? fmt::format("{:.1f}", rate) : "–", "cases per second");
    html += Tile(campaign.at("eta_s").is_null() ? "–" : DurationText(campaign.at("eta_s")), "left");
    html += Tile(
        fmt::format("{}", workers.size()),
        fmt::format("worker{} with {} slot{}", workers.size() == 1 ? "" : "s", slots, slots == 1 ? "" : "s"));
  }
  if (quarantined > 0) html += Tile(fmt::format("{}", quarantined), "cases quarantined");
  html += "</div>\n";
  if (!ended) return html;
  return html +
         "<p>The verdicts and all numbers are in the result folder: <code class=\"command\">dispersa fetch " +
         ShortId(campaign) + " --out DIR</code></p>\n";
}

std::string WorkersHtml(const Json& workers) {
  if (workers.empty()) return "<p>There is no worker.</p>\n";
  HtmlTable table({{"Worker"}, {"Host"}, {"State"}, {"Slots", true}, {"Cases flown", true}});
  for (std::size_t i = 0; i < std::min(workers.size(), kMaxWorkers); ++i) {
    const Json& worker = workers[i];
    table.Row({"<code>" + HtmlText(ShortId(worker)) + "</code>",
               HtmlText(worker.at("host").get<std::string>()),
               HtmlText(worker.at("state").get<std::string>()),
               std::to_string(worker.at("slots").get<std::uint64_t>()),
               std::to_string(worker.at("flown").get<std::uint64_t>())});
  }
  if (workers.size() > kMaxWorkers) table.Wide(fmt::format("and {} more", workers.size() - kMaxWorkers), "");
  return table.Html();
}

/// The fields from which the report's words for a requirement are made.
RequirementSummary SummaryOf(const Json& requirement) {
  RequirementSummary summary;
  summary.metric = requirement.at("metric");
  const Json &above = requirement.at("above"), &below = requirement.at("below");
  summary.below = !below.is_null();
  summary.limit = summary.below ? below : above;
  if (summary.below && !above.is_null()) summary.low_limit = above.get<double>();
  summary.every_case = requirement.value("every_case", false);
  summary.probability = requirement.at("probability");
  summary.consumer_risk = requirement.at("consumer_risk");
  return summary;
}

std::string RequirementsHtml(const Json& requirements) {
  if (requirements.empty()) return "<p>The campaign has no requirement.</p>\n";
  std::string html;
  for (const Json& requirement : requirements) {
    const RequirementSummary summary = SummaryOf(requirement);
    const MetricInfo info = DescribeMetric(summary.metric);
    const std::string so_far = HtmlText(requirement.at("so_far").get<std::string>());
    html += fmt::format(
        "<section class=\"requirement\"><p class=\"claim\"><span class=\"badge so-far {}\">{} so far</span>"
        "<b>{}</b> {} {}<br><code>{}</code></p>\n<p "
        "class=\"sentence\">{}</p></section>\n",
        so_far, so_far, HtmlText(info.title), HtmlText(LimitWords(summary, info.unit)),
        summary.every_case
            ? std::string("in every case")
            : fmt::format("for {} of flights, consumer risk {}", PercentText(summary.probability),
                          PercentText(summary.consumer_risk)),
        HtmlText(summary.metric), HtmlText(StandingText(requirement)));
  }
  return html;
}

std::string HistogramHtml(const Json& histogram, const Json& requirements, std::int64_t cases) {
  const std::string metric = histogram.at("metric");
  const MetricInfo info = DescribeMetric(metric);
  const std::int64_t n = histogram.at("n");
  if (n == 0) return "";
  const double low = histogram.at("low"), width = histogram.at("width");
  const std::vector<double> counts = histogram.at("counts");
  std::vector<double> edges;
  for (std::size_t i = 0; i <= counts.size(); ++i) edges.push_back(low + static_cast<double>(i) * width);
  SvgChart bars({.label = info.title + (info.unit.empty() ? "" : ", " + info.unit)}, {.label = "cases"}, 520,
                250);
  bars.Bars(edges, counts, "");
  for (const Json& requirement : requirements) {
    if (requirement.at("metric") != metric) continue;
    const RequirementSummary summary = SummaryOf(requirement);
    bars.VerticalLimit(summary.limit, "limit: " + LimitWords(summary, info.unit));
    if (summary.low_limit) bars.VerticalLimit(*summary.low_limit, "");
  }
  const std::string without =
      cases > n ? fmt::format(" {} of {} cases are lost or do not define the metric.", cases - n, cases) : "";
  return Figure(bars.Svg("Histogram of " + info.title),
                fmt::format("{}: histogram of {} completed flights.{}", HtmlText(info.title), n, without));
}

}  // namespace

std::string LivePage(const std::string& id) {
  return PageHead("Campaign " + id, "", kStyle) + "<h1 id=\"name\">Campaign <code>" + HtmlText(id) +
         "</code></h1>\n"
         "<p class=\"soft\">This page updates itself while the campaign flies.</p>\n"
         "<noscript><p class=\"notice\">This page needs a browser that runs its script.</p></noscript>\n"
         "<p class=\"notice\" id=\"connection\" role=\"status\"></p>\n"
         "<p class=\"notice\" id=\"notice\" role=\"status\"></p>\n"
         "<div id=\"progress\"></div>\n"
         "<h2>Requirements so far</h2>\n"
         "<p class=\"soft\">These come from the exact binomial limits of the cases flown so far; a study has "
         "no such limits. No verdict uses them.</p>\n"
         "<div id=\"requirements\"></div>\n"
         "<h2>Distribution of key metrics</h2>\n"
         "<div class=\"figures\" id=\"histograms\"></div>\n"
         "<h2>Workers</h2>\n"
         "<div id=\"workers\"></div>\n"
         "<script>" +
         kScript + "</script>\n</body>\n</html>\n";
}

std::string ContentSecurityPolicy(const std::string& page) {
  return fmt::format(
      "default-src 'none'; style-src {}; script-src {}; connect-src 'self'; base-uri 'none'; form-action "
      "'none'; "
      "frame-ancestors 'none'",
      SourceHash(Between(page, "<style>", "</style>")), SourceHash(Between(page, "<script>", "</script>")));
}

LiveParts StatusParts(const Json& status) {
  const Json &campaign = status.at("campaigns").at(0), &workers = status.at("workers");
  const std::string name = campaign.at("name");
  const auto done = campaign.at("done").get<std::uint64_t>(),
             total = campaign.at("total").get<std::uint64_t>();
  return {{"title",
           fmt::format("{} {} {}/{} – dispersa", name, campaign.at("state").get<std::string>(), done, total)},
          {"name", fmt::format("{} <code>{}</code>", HtmlText(name), HtmlText(ShortId(campaign)))},
          {"progress", ProgressHtml(campaign, workers)},
          {"workers", WorkersHtml(workers)}};
}

LiveParts TallyParts(const Json& tally) {
  const std::int64_t cases = tally.at("n");
  if (tally.at("histograms").empty()) return {};  // not known, or not any more: what is shown stays
  std::string figures;
  for (const Json& histogram : tally.at("histograms")) {
    figures += HistogramHtml(histogram, tally.at("requirements"), cases);
  }
  if (figures.empty()) figures = "<p>No flight is completed yet.</p>\n";
  return {{"requirements", RequirementsHtml(tally.at("requirements"))}, {"histograms", figures}};
}

LiveParts NoticeParts(const std::string& notice) { return {{"notice", HtmlText(notice)}}; }

}  // namespace dispersa
