// From a launched campaign to its book: text parsed, result folder opened, what others have flown taken over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/ledger/campaign_book.h"

namespace dispersa {

struct CampaignOpening {
  std::string text;  ///< canonical
  std::string name;  ///< for messages
  std::filesystem::path results;
  /// Result folders of the same flight id, which nobody writes now.
  std::vector<std::filesystem::path> same_flights;
  std::uint64_t number = 1;  ///< of this opening: attempts of different ones differ
  AuditOptions audit;
};

/// May take minutes when there are many results. Throws InputError, ResultError.
std::unique_ptr<CampaignBook> OpenBook(const CampaignOpening& opening);

}  // namespace dispersa
