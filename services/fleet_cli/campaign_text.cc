#include "services/fleet_cli/campaign_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <utility>

#include "services/cli/progress.h"

namespace dispersa {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kLineWidth = 80;  // columns
constexpr std::size_t kDetailIndent = 14;

/// Columns of a text in UTF-8.
std::size_t WidthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}

/// Lines of at most kLineWidth columns, unless one item alone is wider. All but the first are indented.
class Paragraph {
 public:
  explicit Paragraph(const std::string& first) : text_(first), column_(WidthOf(first)) {}

  void Add(const std::string& item, std::size_t gap = 2) {
    if (column_ + gap + WidthOf(item) > kLineWidth) {
      text_ += "\n" + std::string(kDetailIndent, ' ');
      column_ = kDetailIndent;
    } else {
      text_ += std::string(gap, ' ');
      column_ += gap;
    }
    text_ += item;
    column_ += WidthOf(item);
  }
  void AddWords(const std::string& sentence) {
    std::istringstream words(sentence);
    std::size_t gap = 2;
    for (std::string word; words >> word; gap = 1) Add(word, gap);
  }
  void AddLine(const std::string& line) {
    text_ += "\n" + line;
    column_ = kLineWidth;
  }
  std::string Take() { return std::move(text_) + "\n"; }

 private:
  std::string text_;
  std::size_t column_;
};

/// Empty: none, or an earlier coordinator does not say it.
std::string TextIn(const Json& campaign, const char* key) {
  return campaign.contains(key) && !campaign.at(key).is_null() ? campaign.at(key).get<std::string>() : "";
}

}  // namespace

std::string ShortId(const Json& what) {
  const std::string id = what.at("id");
  const std::size_t engine = id.find('-');
  return id.substr(0, 12) + (engine == std::string::npos ? "" : id.substr(engine));
}

std::string StandingText(const Json& standing) {
  return fmt::format("{} of {} fail {} ({} so far)", standing.at("failures").get<std::int64_t>(),
                     standing.at("n").get<std::int64_t>(), standing.at("metric").get<std::string>(),
                     standing.at("so_far").get<std::string>());
}

std::string CampaignStatusText(const Json& campaign) {
  const std::string name = campaign.at("name"), launched = TextIn(campaign, "launched_utc");
  Paragraph text(fmt::format(
      "{}  {:<9}  {:>7}/{:<7}  {:<17}", ShortId(campaign), campaign.at("state").get<std::string>(),
      campaign.at("done").get<std::uint64_t>(), campaign.at("total").get<std::uint64_t>(),
      launched.size() < 16 ? "-" : launched.substr(0, 10) + " " + launched.substr(11, 5) + "Z"));
  text.Add(name);
  if (const double rate = campaign.at("rate_per_s"); rate > 0.0) text.Add(fmt::format("{:.1f}/s", rate));
  if (!campaign.at("eta_s").is_null()) text.Add(DurationText(campaign.at("eta_s")) + " left");
  if (const auto quarantined = campaign.at("quarantined").get<std::uint64_t>(); quarantined > 0)
    text.Add(fmt::format("{} quarantined", quarantined));
  if (const std::string words = TextIn(campaign, "verdict_words"); !words.empty()) text.Add(words);
  if (const std::string owner = TextIn(campaign, "owner"); !owner.empty()) text.Add("of " + owner);
  if (const std::string engine = TextIn(campaign, "engine"); !engine.empty()) text.Add("engine " + engine);
  for (const Json& label : campaign.value("labels", Json::array())) text.Add(label);
  if (const std::string problem = TextIn(campaign, "problem"); !problem.empty()) text.AddWords(problem);
  for (const Json& standing : campaign.at("requirements")) text.AddLine("  " + StandingText(standing));
  return text.Take();
}

}  // namespace dispersa
