// A campaign in the ledgers of attempts (core/results/attempt_ledger.h), while and after it is flown.
#pragma once

#include <filesystem>
#include <string>

#include "services/ledger/campaign_book.h"

namespace dispersa {

/// Before the first case. What goes wrong in `root` is logged.
void BeginAttemptIn(const std::filesystem::path& root, const std::filesystem::path& results,
                    const Campaign& campaign, const std::string& fresh = "");

/// Of one that ends before it is complete: it counts up to its last assigned case, and a case without a
/// result as a failure. The book keeps a tally.
void NoteCancelledIn(const std::filesystem::path& root, const std::filesystem::path& results,
                     const CampaignBook& book);

/// Of one whose reports are written.
void NoteEndedIn(const std::filesystem::path& root, const ResultFolder& folder, const Campaign& campaign,
                 const CampaignSummary& summary);

}  // namespace dispersa
