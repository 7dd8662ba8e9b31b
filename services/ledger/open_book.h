// Makes the book of a launched campaign: parses its text, opens its result folder, and copies results that
// other campaigns have of the same flights.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/ledger/campaign_book.h"

namespace dispersa {

struct BookRequest {
  std::string text;  ///< canonical
  std::string name;  ///< for messages
  std::filesystem::path results;
  std::filesystem::path root;  ///< folder of the ledger of attempts
  /// Result folders of the same flight id that no process writes now.
  std::vector<std::filesystem::path> same_flights;
  std::uint64_t number = 1;  ///< of this book: books of one coordinator use different attempt numbers
  AuditOptions audit;
  /// Workers (IsMeantBy) whose results are removed and flown again. Their results in other folders are not
  /// copied.
  std::vector<std::string> distrusted = {};
};

/// May take minutes when there are many results. Throws InputError, ResultError.
std::unique_ptr<CampaignBook> OpenBook(const BookRequest& opening);

}  // namespace dispersa
