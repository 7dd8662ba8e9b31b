// Two results of one case, column by column.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/case_result.h"

namespace dispersa {

struct ResultDifference {
  std::string name;  ///< of the column in cases.csv
  std::string first;
  std::string second;
};

/// As results are stored: undefined is undefined, -0 is 0. None: the same to the last bit. In the order of
/// the columns, the digest last. Both of one vehicle.
std::vector<ResultDifference> Differences(const CaseResult& first, const CaseResult& second);

}  // namespace dispersa
