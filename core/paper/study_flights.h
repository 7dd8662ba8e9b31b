// A campaign flown in process for a page that compares many of them: no folder, no database.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/analysis/flight_bands.h"
#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// How much of a campaign is flown and kept.
struct StudyOptions {
  std::uint64_t cases = 0;      ///< instead of the campaign's own number; 0: that
  std::uint64_t histories = 0;  ///< number of first cases that keep a time history
  std::vector<int> columns;     ///< of HistoryColumns(), that a time history keeps
  double step_s = 0.1;          ///< of the time histories
  int threads = 1;              ///< the results do not depend on it
  /// Called with the number of cases flown so far, one call at a time, from any of the threads.
  std::function<void(std::uint64_t)> progress;
};

struct StudyFlights {
  CaseColumns cases;                     ///< with all inputs
  std::vector<SampledFlight> histories;  ///< shape (flights, columns, steps)
};

StudyFlights FlyStudy(const Campaign& campaign, const StudyOptions& options);

}  // namespace dispersa
