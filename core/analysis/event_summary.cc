#include "core/analysis/event_summary.h"

#include <algorithm>

namespace dispersa {

std::vector<EventSummary> SummarizeEvents(const CaseColumns& cases) {
  std::vector<EventSummary> events;
  for (const auto& [name, values] : cases.events) {
    EventSummary& event = events.emplace_back();
    event.name = name;
    for (std::size_t i = 0; i < event.values.size(); ++i) event.values[i] = Summarize(values->Read(i));
  }
  std::stable_sort(events.begin(), events.end(), [](const EventSummary& a, const EventSummary& b) {
    return a.values[0].p50 < b.values[0].p50;
  });
  return events;
}

}  // namespace dispersa
