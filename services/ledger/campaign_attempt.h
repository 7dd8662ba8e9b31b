// A campaign in the ledgers of attempts (core/results/attempt_ledger.h), while and after it is flown.
#pragma once

#include <filesystem>
#include <string>

#include "services/ledger/campaign_book.h"

namespace dispersa {

/// Before the first case. Errors in `root` are logged.
void BeginAttemptIn(const std::filesystem::path& root, const std::filesystem::path& results,
                    const Campaign& campaign, const std::string& fresh = "");

/// For a campaign that ends before it is complete. Its cases count up to the last assigned one, and a case
/// without a result counts as a failure. The book keeps a tally.
void NoteCancelledIn(const std::filesystem::path& root, const std::filesystem::path& results,
                     const CampaignBook& book);

/// For a campaign whose reports are written.
void NoteEndedIn(const std::filesystem::path& root, const ResultFolder& folder, const Campaign& campaign,
                 const CampaignSummary& summary);

}  // namespace dispersa
