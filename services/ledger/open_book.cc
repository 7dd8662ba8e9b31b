#include "services/ledger/open_book.h"

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/results/folder_state.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/take_over.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

/// Attempts of one opening: more than any has.
constexpr std::uint64_t kAttempts = std::uint64_t{1} << 40;

bool HasResults(const fs::path& directory) {
  std::error_code error;
  return fs::is_regular_file(directory / "results.sqlite", error);
}

/// A folder that another engine made and never flew a case of.
bool IsEmptyOfAnotherEngine(const fs::path& directory) {
  const FolderState state = ReadFolderState(directory);
  return state.engine != EngineVersion() && state.cases == 0 && state.quarantined == 0;
}

/// What others have flown saves time; what is wrong with their folders is no reason to fail.
void TryToTakeOver(const fs::path& from, const Campaign& campaign, const std::vector<std::string>& distrusted,
                   ResultFolder& to) {
  try {
    const ResultFolder folder = ResultFolder::Open(from);
    if (folder.Provenance("flight_id") != campaign.flight_id) return;
    if (const std::uint64_t others = TakeOver(folder, campaign, distrusted, to).others; others > 0) {
      LogWarning("{}: {} results are not taken over: their inputs are not those that the campaign draws",
                 from.string(), others);
    }
  } catch (const InputError& error) {
    LogWarning("{}: its results are not taken over: {}", from.string(), error.what());
  } catch (const ResultError& error) {
    if (error.kind() == ResultError::Kind::kDiskFull) throw;
    LogWarning("{}: its results are not taken over: {}", from.string(), error.what());
  }
}

}  // namespace

std::unique_ptr<CampaignBook> OpenBook(const BookRequest& opening) {
  const Campaign campaign = ParseCampaign(opening.text, opening.name);
  const LogAbout about(campaign.id);
  const bool is_new = !HasResults(opening.results) || IsEmptyOfAnotherEngine(opening.results);
  if (is_new) {
    // Of a start that was killed: nothing is in it.
    std::error_code error;
    fs::remove_all(opening.results, error);
  }
  ResultFolder folder = is_new ? ResultFolder::Create(opening.results, campaign)
                               : ResultFolder::Resume(opening.results, campaign);
  for (const std::uint64_t damaged : folder.damaged()) {
    LogWarning("{}: the row of case {} is damaged; it is flown again", opening.results.string(), damaged);
  }
  for (const std::string& worker : opening.distrusted) {
    const std::size_t removed = folder.Disown(worker).size();
    if (removed == 0) continue;
    LogWarning("{}: {} results of {} are removed; their cases are flown again", opening.results.string(),
               removed, worker);
  }
  BeginAttemptIn(opening.root, opening.results, campaign);
  // Each time: what a start that was killed did not take over is taken now. A campaign that stops by itself
  // takes none, because what it flies depends on its own looks alone.
  if (!campaign.verdicts.stop_when_decided) {
    for (const fs::path& other : opening.same_flights) {
      if (HasResults(other)) TryToTakeOver(other, campaign, opening.distrusted, folder);
    }
  }
  LedgerOptions options;
  options.attempt_base = opening.number * kAttempts;
  auto book = std::make_unique<CampaignBook>(campaign, std::move(folder), options);
  book->PauseOnDiskErrors();
  book->KeepTally();
  book->KeepAudit(opening.audit);
  return book;
}

}  // namespace dispersa
