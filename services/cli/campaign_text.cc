#include "services/cli/campaign_text.h"

#include <fmt/format.h>

#include "services/cli/progress.h"

namespace dispersa {

using Json = nlohmann::ordered_json;

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
  const auto done = campaign.at("done").get<std::uint64_t>(),
             total = campaign.at("total").get<std::uint64_t>();
  std::string text =
      fmt::format("{}  {:<10} {:>9}/{:<9} {}", ShortId(campaign), campaign.at("state").get<std::string>(),
                  done, total, campaign.at("name").get<std::string>());
  if (const double rate = campaign.at("rate_per_s"); rate > 0.0) text += fmt::format("  {:.1f}/s", rate);
  if (!campaign.at("eta_s").is_null()) text += "  " + DurationText(campaign.at("eta_s")) + " left";
  if (const auto quarantined = campaign.at("quarantined").get<std::uint64_t>(); quarantined > 0) {
    text += fmt::format("  {} quarantined", quarantined);
  }
  if (!campaign.at("code").is_null()) text += fmt::format("  exit code {}", campaign.at("code").get<int>());
  if (campaign.contains("owner") && !campaign.at("owner").is_null())
    text += "  of " + campaign.at("owner").get<std::string>();
  if (campaign.contains("engine") && !campaign.at("engine").is_null())
    text += "  engine " + campaign.at("engine").get<std::string>();
  if (!campaign.at("problem").is_null()) text += "  " + campaign.at("problem").get<std::string>();
  text += "\n";
  for (const Json& standing : campaign.at("requirements")) text += "  " + StandingText(standing) + "\n";
  return text;
}

}  // namespace dispersa
