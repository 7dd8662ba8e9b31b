// Events of the flights (core/flight/seen_event.h): when and how, over all cases.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/results/case_columns.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// Over all flights in which it happened, completed or not.
struct EventSummary {
  std::string name;
  std::array<Summary, SeenEvent::kValues.size()> values;  ///< as kEventValueNames

  std::size_t flights() const { return values[0].n; }
};

/// By median time; of one time as they happen.
std::vector<EventSummary> SummarizeEvents(const CaseColumns& cases);

}  // namespace dispersa
