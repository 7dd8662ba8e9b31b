#include "services/fleet/data_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/sha256.h"
#include "core/input/input_error.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"
#include "services/coordinator/catalogue.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/expulsions.h"
#include "services/coordinator/sealed_json.h"
#include "services/program/exit_code.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

/// From its text and its results. None: neither says enough.
std::optional<CatalogueEntry> MadeAnew(CatalogueEntry entry, const fs::path& folder) {
  try {
    const fs::path text = folder / kTextFile;
    if (Sha256OfFile(text) == CampaignIdOf(entry.id)) {
      const Campaign campaign = ParseCampaign(ReadWholeFile(text), entry.id);
      entry.name = campaign.name;
      entry.seed = campaign.sampling.seed;
      entry.design_id = campaign.design_id;
      entry.cases = std::max(entry.cases, campaign.sampling.cases);
      if (entry.flight_id.empty()) entry.flight_id = campaign.flight_id;
    }
  } catch (const InputError&) {
    // Its results may know enough.
  }
  if (entry.cases == 0 || entry.flight_id.empty()) return std::nullopt;
  const bool is_flown = entry.done + entry.quarantined >= entry.cases;
  entry.state = is_flown ? CampaignState::kWaiting : CampaignState::kCancelled;
  entry.code = is_flown ? 0 : kExitIncomplete;
  entry.problem =
      is_flown ? "" : "its state was damaged and is made anew: launch the campaign again to go on";
  if (is_flown) entry.ended_unix_s = 0;
  return entry;
}

void CheckCampaign(FolderCheck& check, Catalogue& catalogue, const std::string& id, const fs::path& folder) {
  const CatalogueEntry entry = catalogue.At(id);
  const fs::path results = folder / kResultsFolder;
  const auto write = [&](CatalogueEntry changed) {
    catalogue.Write(changed);
    catalogue.At(id) = std::move(changed);
    return true;
  };
  // First what its state is made of.
  CheckText(check, folder / kTextFile, CampaignIdOf(id), results / kTextFile);
  if (entry.state == CampaignState::kDamaged) {
    const bool is_newer = entry.problem.find("newer dispersa") != std::string::npos;
    const std::string what =
        entry.problem.substr(sizeof kStateFile, entry.problem.find(": stop") - sizeof kStateFile);
    const auto anew = is_newer ? std::nullopt : MadeAnew(entry, folder);
    check.Found(folder / kStateFile, what,
                is_newer ? "use that dispersa"
                : anew   ? "--repair makes it anew from the results; owner, labels and priority are lost"
                         : kFromBackup,
                anew ? std::function<bool()>([&] { return write(*anew); }) : nullptr);
  }
  std::error_code error;
  if (!fs::exists(results / kDatabaseName, error)) {
    if (entry.done > 0) check.Found(results / kDatabaseName, "is missing", kFromBackup);
    return;
  }
  const auto fly_again = [&] {
    CatalogueEntry again = catalogue.At(id);
    QueueAgain(&again);
    return write(again);
  };
  CheckResults(check, results, folder / kTextFile,
               "--repair lets the coordinator fly their cases and write the reports again", fly_again);
  const auto state = StateOf(results);
  if (state && entry.state == CampaignState::kDone && state->cases < entry.done)
    check.Found(results / kDatabaseName,
                fmt::format("has {} cases and {} promises {}", state->cases, kStateFile, entry.done),
                "--repair lets the coordinator fly the others again", fly_again);
}

void CheckData(FolderCheck& check, const fs::path& data) {
  Catalogue catalogue(data);
  const fs::path epoch = data / kEpochFile, expelled = data / kExpelledFile;
  try {
    ReadEpoch(epoch);
  } catch (const InputError&) {
    check.Found(epoch, "is not as it was written",
                "--repair removes it, and the next start is numbered by the clock",
                [&] { return fs::remove(epoch); });
  }
  try {
    if (fs::exists(expelled)) ReadExpulsions(ReadWholeFile(expelled));
  } catch (const std::exception&) {
    check.Found(expelled, "is not as it was written",
                "copy it from a backup; without it all expelled workers fly again");
  }
  std::vector<std::string> ids;
  for (const auto& [id, entry] : catalogue.entries()) ids.push_back(id);
  for (const std::string& id : ids) CheckCampaign(check, catalogue, id, data / id);
}

bool IsDataFolder(const fs::path& folder) {
  if (fs::exists(folder / kEpochFile) || fs::exists(folder / kExpelledFile)) return true;
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry& each) {
                       return fs::exists(each.path() / kStateFile) ||
                              fs::exists(each.path() / kResultsFolder / kDatabaseName);
                     });
}

}  // namespace

bool CheckDataFolder(FolderCheck& check, const fs::path& folder) {
  if (!IsDataFolder(folder)) return false;
  CheckData(check, folder);
  return true;
}

}  // namespace dispersa
