#include "services/ledger/campaign_attempt.h"

#include <cstdint>
#include <optional>
#include <vector>

#include "services/log/log.h"
#include "services/program/utc.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

void Warn(const std::optional<std::string>& problem) {
  if (problem)
    LogWarning("the ledger of attempts cannot be kept, so that later campaigns do not know of this one: {}",
               *problem);
}

}  // namespace

void BeginAttemptIn(const fs::path& root, const fs::path& results, const Campaign& campaign,
                    const std::string& fresh) {
  Warn(BeginAttempt(root, results, campaign, UtcNow(), fresh));
}

void NoteCancelledIn(const fs::path& root, const fs::path& results, const CampaignBook& book) {
  AttemptRecord record = RecordOf(book.campaign());
  for (const AttemptRecord& one : AttemptLedger(results / kFolderLedgerName).Read())
    if (one.id == record.id) record = one;
  const LedgerProgress progress = book.ledger().Progress();
  record.cases = static_cast<std::int64_t>(progress.total - progress.waiting);
  record.verdict = StandingVerdictName(StandingVerdict::kIncomplete);
  const std::vector<RequirementStanding> standings = book.tally().Standings();
  for (std::size_t i = 0; i < record.requirements.size() && i < standings.size(); ++i) {
    record.requirements[i].failures = standings[i].failures + record.cases - standings[i].n;
    record.requirements[i].verdict = "inconclusive";
  }
  Warn(NoteAttempt(root, results, record));
}

void NoteEndedIn(const fs::path& root, const ResultFolder& folder, const Campaign& campaign,
                 const CampaignSummary& summary) {
  Warn(RecordAttempt(root, folder, campaign, summary));
}

}  // namespace dispersa
