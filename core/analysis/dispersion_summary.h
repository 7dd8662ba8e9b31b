// Dispersions as declared against the inputs that the flights applied: a dispersion that never reached the
// flights shows here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// One input that a dispersion feeds. Numbers in the unit of the input's name.
struct DispersionSummary {
  std::string dispersion;  ///< its name
  std::string input;       ///< column, without the prefix
  std::string key;         ///< what the campaign file calls it
  std::string declared;    ///< "normal, mean 1, 3σ 0.02"
  /// Of the declared distribution; none when several dispersions feed the input, or the design decides.
  std::optional<double> expected_mean;
  std::optional<double> expected_std;
  Summary drawn;
  /// Mean and standard deviation lie within 5 standard errors of the declared ones; none below 10 cases or
  /// without expectation. Of a thousand true statements fewer than one is doubted.
  std::optional<bool> consistent;
};

/// Positions in InputColumns() that any dispersion feeds, ascending.
std::vector<int> DispersedInputs(const Campaign& campaign);

std::vector<DispersionSummary> SummarizeDispersions(const Campaign& campaign, const CaseColumns& cases);

}  // namespace dispersa
