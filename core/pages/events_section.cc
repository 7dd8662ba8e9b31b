#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

struct Shown {
  const char* title;
  double per_unit;
  double least = 0.0;  ///< what is smaller is shown as 0
};
// As kEventValueNames.
constexpr Shown kShown[] = {{"Time, s", 1.0},
                            {"Altitude, km", 1e-3, 5e-4},
                            {"Speed, m/s", 1.0, 5e-3},
                            {"q, kPa", 1e-3, 5e-4},
                            {"Mass, kg", 1.0}};

std::string Cell(const Summary& over, const SeenEvent* nominal, double SeenEvent::*value, const Shown& as) {
  const auto text = [&](double number) {
    const double shown = number * as.per_unit;
    return ScatterText(std::fabs(shown) < as.least ? 0.0 : shown, over.std * as.per_unit);
  };
  std::string cell = nominal == nullptr ? "–" : text(nominal->*value);
  cell += "<span class=\"definition\">";
  if (over.n == 0)
    cell += "–";
  else if (over.min == over.max || std::fabs(over.max) * as.per_unit < as.least)
    cell += text(over.max);
  else if (text(over.p01) == text(over.p99))
    cell += text(over.p50);
  else
    cell += text(over.p01) + " · " + text(over.p50) + " · " + text(over.p99);
  return cell + "</span>";
}

}  // namespace

std::string EventWords(const std::string& name, const Vehicle& vehicle) {
  constexpr std::string_view kJettison = "jettison_";
  if (name.starts_with(kJettison)) {
    std::size_t number = 0;
    std::from_chars(name.data() + kJettison.size(), name.data() + name.size(), number);
    for (const Stage& stage : vehicle.stages)
      for (const Jettison& body : stage.jettisoned)
        if (--number == 0) return "jettison: " + HtmlText(body.name);
  }
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return HtmlText(words);
}

std::string EventsSection(const Campaign& campaign, const CampaignSummary& summary) {
  if (summary.events.empty()) return "";
  std::string titles = "!Event|#Flights";
  for (const Shown& each : kShown) titles += fmt::format("|#{}", each.title);
  HtmlTable table(titles);
  for (const EventSummary& event : summary.events) {
    const SeenEvent* const nominal =
        summary.nominal ? FindEvent(summary.nominal->events, event.name) : nullptr;
    std::vector<std::string> row = {EventWords(event.name, campaign.vehicle),
                                    std::to_string(event.flights())};
    for (std::size_t i = 0; i < event.values.size(); ++i)
      row.push_back(Cell(event.values[i], nominal, SeenEvent::kValues[i], kShown[i]));
    table.Row(row);
  }
  return "<h2 id=\"events\">Events</h2>\n<p>The nominal flight, and below it 1 %, 50 % and 99 % of the "
         "flights "
         "in which the event happened. Speed is over the rotating Earth. The vehicle is as it was right "
         "after "
         "the event. Each flight’s events are in the table <code>events</code> of "
         "<code>results.sqlite</code>.</p>\n" +
         table.Html();
}

}  // namespace dispersa
