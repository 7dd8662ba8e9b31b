// Declared dispersions compared with the inputs that the flights applied. A dispersion that never reached the
// flights is visible here.
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
  std::string key;         ///< its name in the campaign file
  std::string declared;    ///< "normal, mean 1, 3σ 0.02"
  std::string unread;      ///< why no part of the flight reads it; empty: one does
  /// Of the declared distribution. None if several dispersions feed the input, if the design decides its
  /// values, or if directions lie all around: they have no mean.
  std::optional<double> expected_mean;
  std::optional<double> expected_std;
  Summary drawn;
  /// Mean and standard deviation lie within 5 standard errors of the declared ones. None with fewer than 10
  /// cases, or without an expectation. The test is wrong about fewer than one of a thousand correct inputs.
  std::optional<bool> consistent;
};

std::vector<DispersionSummary> SummarizeDispersions(const Campaign& campaign, const CaseColumns& cases);

}  // namespace dispersa
