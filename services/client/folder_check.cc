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
#include "services/program/threads.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

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

void CheckReports(FolderCheck& check, const fs::path& results) {
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

}  // namespace

void FolderCheck::Found(const fs::path& file, const std::string& what, const std::string& to_do,
                        const std::function<bool()>& mend) {
  FolderProblem problem = {file.string(), what, to_do};
  try {
    problem.is_mended = repair_ && mend && mend();
  } catch (const std::exception& error) {
    problem.mend += fmt::format(", which failed: {}", error.what());
  }
  problems_.push_back(std::move(problem));
}

std::vector<FolderProblem> FolderCheck::Take() { return std::move(problems_); }

std::optional<FolderState> StateOf(const fs::path& results) {
  try {
    return ReadFolderState(results);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void CheckText(FolderCheck& check, const fs::path& file, const std::string& id, const fs::path& copy) {
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

void CheckResults(FolderCheck& check, const fs::path& results, const fs::path& text,
                  const std::string& fly_again, const std::function<bool()>& queue) {
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

std::vector<FolderProblem> CheckFiles(const fs::path& results) {
  FolderCheck check(false);
  CheckText(check, results / kTextFile, ReadFolderState(results).campaign_id);
  CheckReports(check, results);
  return check.Take();
}

std::vector<FolderProblem> CheckFolder(const fs::path& folder, bool repair, OtherFolder other) {
  FolderCheck check(repair);
  const std::string allowed =
      other ? "a result folder, or the data folder of a coordinator" : "a result folder";
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder.string() + ": is no folder", allowed);
  if (fs::exists(folder / kDatabaseName) || fs::exists(folder / "cases.csv")) {
    const FolderLock lock(folder);
    CheckResults(check, folder, "",
                 "`dispersa run CAMPAIGN --out " + folder.string() + " --resume` flies their cases again",
                 nullptr);
  } else if (!other || !other(check, folder)) {
    throw InputError(folder.string() + ": holds no results and no campaigns", allowed);
  }
  return check.Take();
}

}  // namespace dispersa
