// Copies results from one folder to another of the same flights.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct TakenOver {
  std::uint64_t results = 0;
  std::uint64_t others = 0;  ///< left, because their inputs are not those that the campaign draws
};

/// Takes the results that `to`, a folder of `campaign`, lacks, each with its worker. Nothing of the
/// `distrusted` workers (IsMeantBy) is taken, and nothing at all if `from` lacks a metric of the campaign's
/// own. Throws ResultError.
TakenOver TakeOver(const ResultFolder& from, const Campaign& campaign,
                   const std::vector<std::string>& distrusted, ResultFolder& to);

}  // namespace dispersa
