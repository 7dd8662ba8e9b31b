#include "services/client/stored_campaign.h"

#include <fmt/format.h>

#include <utility>

#include "core/analysis/campaign_summary.h"
#include "core/campaign_yaml/load.h"
#include "core/input/input_error.h"

namespace dispersa {

StoredCampaign OpenStored(const std::string& directory, bool may_be_empty) {
  ResultFolder folder = ResultFolder::Open(directory);
  Campaign campaign = ReadFlownCampaign((folder.directory() / "campaign.yaml").string());
  campaign.flight_id = folder.Provenance("flight_id");  // of the engine that flew it
  // The text was changed after the flights.
  if (campaign.own_metrics.size() != folder.own_metrics().size() ||
      !FindOwn(campaign.own_metrics, folder.own_metrics()))
    throw InputError(directory + ": the metrics of its campaign.yaml are not those that were measured",
                     "`dispersa run CAMPAIGN --out " + directory + " --resume`, which flies the cases again");
  const std::uint64_t flown = folder.CaseCount();
  const std::optional<CaseShare> share = folder.ItsShare();
  // The rows decide where a campaign stops by itself, those of a share do not.
  const std::uint64_t cases = campaign.verdicts.stop_when_decided && flown > 0 && !share
                                  ? CasesToFly(folder, campaign, ReadColumns(folder, {}))
                                  : campaign.sampling.cases;
  std::string incomplete;
  if (share || flown < cases)
    incomplete = fmt::format("incomplete: {}{}",
                             share ? "it is the share of " + CasesText(share->cases) + ", and " : "",
                             MissingWords(flown, cases));
  if (flown == 0 && !may_be_empty)
    throw ResultError(ResultError::Kind::kFewer,
                      fmt::format("{}: {}; copy results.sqlite-wal too if this is a copy, or fly the cases: "
                                  "`dispersa run CAMPAIGN --out {} --resume`",
                                  directory, incomplete, directory));
  return {std::move(folder), std::move(campaign), cases, std::move(incomplete)};
}

}  // namespace dispersa
