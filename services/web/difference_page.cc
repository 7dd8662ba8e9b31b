#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/campaign_yaml/text_differences.h"
#include "core/input/input_error.h"
#include "core/pages/html_parts.h"
#include "core/results/text.h"
#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

using DriverJson = nlohmann::ordered_json;

constexpr std::size_t kMostValues = 300;

std::string ValueText(const std::string& value) {
  return value.empty() ? "<span class=\"soft\">–</span>" : Code(value);
}

std::string Inputs(const CampaignRow& a, const CampaignRow& b, const CampaignFile& file) {
  const auto text_a = file(a.id, "campaign.yaml"), text_b = file(b.id, "campaign.yaml");
  if (!text_a || !text_b) return "<p>A campaign's text cannot be read.</p>\n";
  std::vector<ValueDifference> found;
  try {
    found = DifferencesOf(*text_a, *text_b);
  } catch (const InputError&) {
    return "<p>A campaign's text is damaged.</p>\n";
  }
  if (found.empty()) return "<p>Both have the same text.</p>\n";
  HtmlTable table("Value|A|B");
  for (std::size_t i = 0; i < std::min(found.size(), kMostValues); ++i)
    table.Row({Code(found[i].path), ValueText(found[i].a), ValueText(found[i].b)});
  if (found.size() > kMostValues)
    table.Wide(fmt::format("and {} more values", found.size() - kMostValues), "soft");
  return table.Html();
}

std::string OneOutcome(const RequirementOutcome* one) {
  if (one == nullptr) return "<span class=\"soft\">not required</span>";
  std::string html =
      VerdictBadge(HtmlText(one->verdict)) + fmt::format(" {} of {} fail", one->failures, one->n);
  if (one->success_lower && one->success_upper)
    html += "<br><span class=\"soft\">" + PercentText(*one->success_lower) + " to " +
            PercentText(*one->success_upper) + " meet it</span>";
  return html;
}

std::string Requirements(const CampaignRow& a, const CampaignRow& b) {
  std::vector<std::string> words;
  std::map<std::string, std::pair<const RequirementOutcome*, const RequirementOutcome*>> both;
  for (const RequirementOutcome& one : a.requirements) {
    words.push_back(one.words);
    both[one.words].first = &one;
  }
  for (const RequirementOutcome& one : b.requirements) {
    if (!both.contains(one.words)) words.push_back(one.words);
    both[one.words].second = &one;
  }
  if (words.empty()) return "<p>Neither campaign has judged a requirement.</p>\n";
  HtmlTable table("Requirement|A|B");
  for (const std::string& each : words)
    table.Row({HtmlText(each), OneOutcome(both[each].first), OneOutcome(both[each].second)});
  return table.Html();
}

/// Causes of a metric, by falling share: "wind 41 % (30 to 52)".
std::map<std::string, std::string> DriversIn(const std::optional<std::string>& summary) {
  std::map<std::string, std::string> words;
  if (!summary) return words;
  try {
    const DriverJson json = DriverJson::parse(*summary);
    for (const auto& [metric, drivers] : json.at("drivers").items()) {
      std::string& text = words[metric];
      for (const DriverJson& driver : drivers) {
        const auto share = [&](const char* name) { return 100.0 * driver.at(name).get<double>(); };
        text += fmt::format("<li>{} {:.0f} % <span class=\"soft\">({:.0f} to {:.0f})</span></li>",
                            HtmlText(driver.at("input").get<std::string>()), share("index"), share("low"),
                            share("high"));
      }
    }
  } catch (const DriverJson::exception&) {
    words.clear();  // a damaged summary has none
  }
  return words;
}

std::string Drivers(const CampaignRow& a, const CampaignRow& b, const CampaignFile& file) {
  const auto of_a = DriversIn(file(a.id, "summary.json")), of_b = DriversIn(file(b.id, "summary.json"));
  std::set<std::string> metrics;
  for (const auto* one : {&of_a, &of_b})
    for (const auto& [metric, words] : *one)
      if (!words.empty()) metrics.insert(metric);
  if (metrics.empty()) return "<p>Neither campaign names a cause.</p>\n";
  const auto list = [](const std::map<std::string, std::string>& of, const std::string& metric) {
    const auto found = of.find(metric);
    return found == of.end() || found->second.empty() ? std::string("<span class=\"soft\">none</span>")
                                                      : "<ul class=\"plain\">" + found->second + "</ul>";
  };
  HtmlTable table("Metric|A|B");
  for (const std::string& metric : metrics) table.Row({Code(metric), list(of_a, metric), list(of_b, metric)});
  return table.Html("causes");
}

}  // namespace

std::string DifferencePage(const CampaignRow& a, const CampaignRow& b, const CampaignFile& file) {
  HtmlTable heads("|A|B");
  const auto differ = [](const std::string& one, const std::string& other) {
    return one == other ? std::string_view() : std::string_view("differs");
  };
  heads.Row({"Campaign", NameOf(a), NameOf(b)});
  heads.Row({"Verdict", StandingOfRow(a), StandingOfRow(b)},
            differ(a.verdict + a.state, b.verdict + b.state));
  heads.Row({"Engine", ValueText(a.engine), ValueText(b.engine)}, differ(a.engine, b.engine));
  heads.Row({"Cases", std::to_string(a.done), std::to_string(b.done)},
            differ(std::to_string(a.done), std::to_string(b.done)));
  heads.Row({"Owner", HtmlText(a.owner), HtmlText(b.owner)}, differ(a.owner, b.owner));
  heads.Row({"Labels", LabelsOf(a), LabelsOf(b)}, differ(LabelsOf(a), LabelsOf(b)));
  heads.Row({"Launched, UTC", TimeText(a.launched_unix_s), TimeText(b.launched_unix_s)});
  return Frame("Difference", "<h1>Difference of two campaigns</h1>\n" + heads.Html("pair") +
                                 "<h2>Requirements</h2>\n" + Requirements(a, b) + "<h2>Inputs</h2>\n" +
                                 Inputs(a, b, file) +
                                 "<h2>Drivers</h2>\n<p class=\"soft\">Share of a metric's variance, with its "
                                 "confidence interval.</p>\n" +
                                 Drivers(a, b, file));
}

}  // namespace dispersa
