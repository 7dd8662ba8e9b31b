#include "services/client/folder_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <system_error>
#include <utility>

#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/sha256.h"
#include "core/flight/engine_version.h"
#include "core/input/input_error.h"
#include "core/pages/report_sums.h"
#include "core/pages/reports.h"
#include "core/results/folder_state.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"
#include "services/client/stored_campaign.h"
#include "services/coordinator/catalogue.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/expulsions.h"
#include "services/coordinator/sealed_json.h"
#include "services/program/exit_code.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kFromBackup[] = "copy it from a backup";

class Check {
 public:
  explicit Check(bool repair) : repair_(repair) {}

  /// `mend` returns whether the file is whole now; without one nothing here can mend it.
  void Found(const fs::path& file, const std::string& what, const std::string& to_do,
             const std::function<bool()>& mend = nullptr) {
    FolderProblem problem = {file.string(), what, to_do};
    try {
      problem.is_mended = repair_ && mend && mend();
    } catch (const std::exception& error) {
      problem.mend += fmt::format(", which failed: {}", error.what());
    }
    problems_.push_back(std::move(problem));
  }
  std::vector<FolderProblem> Take() { return std::move(problems_); }

 private:
  bool repair_;
  std::vector<FolderProblem> problems_;
};

std::optional<FolderState> StateOf(const fs::path& results) {
  try {
    return ReadFolderState(results);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// Why the rows cannot all be read as they were written; empty: they can. `damaged`: how many are not whole.
std::string WhyUnreadable(const fs::path& results, std::uint64_t* damaged) {
  try {
    const std::string pages = DamagedPages(results);
    if (!pages.empty()) return pages;
    const FolderState state = ReadFolderState(results);
    *damaged = state.engine == EngineVersion() ? ResultFolder::Open(results).CountDamaged() : 0;
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// The reports from the rows.
bool WriteAgain(const fs::path& results) {
  StoredCampaign stored = OpenStored(results.string());
  std::error_code ignored;
  const std::vector<std::string> changed = ChangedReports(results);
  if (std::find(changed.begin(), changed.end(), "cases.csv") != changed.end())
    fs::remove(results / "cases.csv", ignored);  // whatever number of cases it seems to have
  ReportOptions options;
  options.threads = UsableCores();
  WriteReports(stored.folder, stored.campaign, options);
  fs::remove(results / "report.html.gz", ignored);
  return true;
}

void CheckText(Check& check, const fs::path& file, const std::string& id, const fs::path& copy = "") {
  if (Sha256OfFile(file) == id) return;
  const auto take_copy = [&] {
    if (Sha256OfFile(copy) != id) return false;
    WriteFile(file, ReadWholeFile(copy));
    return true;
  };
  const bool has_copy = !copy.empty() && Sha256OfFile(copy) == id;
  check.Found(file, "is not the campaign that was flown",
              has_copy ? "--repair takes the copy in " + copy.string() : kFromBackup,
              has_copy ? std::function<bool()>(take_copy) : nullptr);
}

void CheckReports(Check& check, const fs::path& results) {
  const std::vector<std::string> changed = ChangedReports(results);
  bool is_written = false;
  for (const std::string& name : changed) {
    check.Found(results / name, "is not as it was written",
                "--repair writes the reports again from results.sqlite", [&] {
                  is_written = is_written || WriteAgain(results);
                  return is_written;
                });
  }
}

/// `fly_again`: what the owner of these results does with rows that are lost.
void CheckResults(Check& check, const fs::path& results, const fs::path& text, const std::string& fly_again,
                  const std::function<bool()>& queue) {
  std::uint64_t damaged = 0;
  if (const std::string why = WhyUnreadable(results, &damaged); !why.empty()) {
    check.Found(results / kDatabaseName, "cannot be read: " + why, kFromBackup);
    return;
  }
  CheckText(check, results / kTextFile, StateOf(results)->campaign_id, text);
  if (damaged == 0) return CheckReports(check, results);
  check.Found(results / kDatabaseName,
              fmt::format("{} row{} not as written", damaged, damaged == 1 ? " is" : "s are"), fly_again,
              queue);
}

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

void CheckCampaign(Check& check, Catalogue& catalogue, const std::string& id, const fs::path& folder) {
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

void CheckData(Check& check, const fs::path& data) {
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

std::vector<FolderProblem> CheckFiles(const fs::path& results) {
  Check check(false);
  CheckText(check, results / kTextFile, ReadFolderState(results).campaign_id);
  CheckReports(check, results);
  return check.Take();
}

std::vector<FolderProblem> CheckFolder(const fs::path& folder, bool repair) {
  Check check(repair);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(folder.string() + ": is no folder",
                     "a result folder, or the data folder of a coordinator");
  if (fs::exists(folder / kDatabaseName) || fs::exists(folder / "cases.csv")) {
    const FolderLock lock(folder);
    CheckResults(check, folder, "",
                 "`dispersa run CAMPAIGN --out " + folder.string() + " --resume` flies their cases again",
                 nullptr);
  } else if (IsDataFolder(folder)) {
    CheckData(check, folder);
  } else {
    throw InputError(folder.string() + ": holds no results and no campaigns",
                     "a result folder, or the data folder of a coordinator");
  }
  return check.Take();
}

}  // namespace dispersa
