// The differences of two results of one case, column by column.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/case_result.h"

namespace dispersa {

struct ResultDifference {
  std::string name;  ///< of the column in cases.csv, or inputs_digest
  std::string first;
  std::string second;
};

/// Compares results as they are stored: undefined equals undefined, -0 equals 0. Empty if they are equal to
/// the last bit. In the order of the columns, with the digest last. Both results have these inputs and
/// metrics.
std::vector<ResultDifference> Differences(const CaseResult& first, const CaseResult& second,
                                          const RowInputs& inputs, const MetricList& metrics);

}  // namespace dispersa
