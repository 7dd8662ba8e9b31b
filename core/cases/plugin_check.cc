#include "core/cases/plugin_check.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "core/cases/result_bytes.h"
#include "core/control/law_here.h"
#include "core/flight/flight_model.h"
#include "core/flight/lane_engine.h"
#include "core/input/input_error.h"

namespace dispersa {
namespace {

// A flight of the check: what it returned, and its history.
struct Flown {
  CaseResult result;
  std::vector<double> history;
};

FlightOrder OrderOf(const CampaignFlights& flights, std::optional<std::uint64_t> case_index,
                    History& history) {
  history.step_s = flights.model().definition().autopilot.tick_s;
  FlightOrder order;
  if (case_index) order.inputs = flights.Draw(*case_index);
  order.options.case_index = case_index.value_or(0);
  order.options.history = &history;
  return order;
}

// A law of this process is flown in it.
void RunWatched(const CampaignFlights& flights, const std::function<void(const Say& say)>& work,
                const Say& hear, const StopCheck& should_stop) {
  if (FunctionsHere(flights.model().autopilot().plugin->config()) != nullptr)
    work(hear);
  else
    RunContained(work, hear, should_stop);
}

// None is the nominal flight.
std::vector<Flown> FlySideBySide(const CampaignFlights& flights,
                                 const std::vector<std::optional<std::uint64_t>>& cases,
                                 const StopCheck& should_stop) {
  std::vector<Flown> all;
  RunWatched(
      flights,
      [&](const Say& say) {
        std::vector<History> histories(cases.size());
        std::vector<FlightOrder> orders;
        for (std::size_t i = 0; i < cases.size(); ++i)
          orders.push_back(OrderOf(flights, cases[i], histories[i]));
        std::vector<FlightResult> results = FlyAll(flights.model(), orders);
        for (std::size_t i = 0; i < cases.size(); ++i) {
          Packer out;
          Pack(ResultOf(flights.model(), cases[i].value_or(0), orders[i].inputs, std::move(results[i])), out);
          out.Numbers(histories[i].values);
          say(out.Take());
        }
      },
      [&](const std::string& message) {
        Unpacker in(message);
        CaseResult result = UnpackResult(in);
        all.push_back({std::move(result), in.Numbers()});
        if (!in.is_whole()) throw Garbled();
      },
      should_stop);
  return all;
}

std::string Difference(const std::vector<double>& first, const std::vector<double>& second) {
  const std::vector<std::string>& columns = HistoryColumns();
  const std::size_t size = std::min(first.size(), second.size());
  for (std::size_t i = 0; i < size; ++i) {
    if (std::memcmp(&first[i], &second[i], sizeof(double)) == 0) continue;
    char text[160];
    std::snprintf(text, sizeof text, "at %.3f s %s is %.17g once and %.17g again",
                  first[i - i % columns.size()], columns[i % columns.size()].c_str(), first[i], second[i]);
    return text;
  }
  return first.size() == second.size() ? "" : "one of the flights ends earlier";
}

// Flies again flights that ended normally before.
std::vector<Flown> FlyAgain(const CampaignFlights& flights,
                            const std::vector<std::optional<std::uint64_t>>& cases,
                            const StopCheck& should_stop) {
  try {
    return FlySideBySide(flights, cases, should_stop);
  } catch (const ContainedEnd& end) {
    throw PluginError("is not deterministic: the same flight ended well once, and again it " +
                      std::string(end.what()));
  }
}

// Each once alone and once beside the others. Returns the cases' results.
std::vector<CaseResult> CompareFlights(const CampaignFlights& flights, std::uint64_t cases,
                                       const StopCheck& should_stop) {
  std::vector<std::optional<std::uint64_t>> checked = {std::nullopt};
  std::vector<Flown> alone, together;
  try {
    alone = FlySideBySide(flights, checked, should_stop);
  } catch (const ContainedEnd& end) {
    throw PluginError(std::string("cannot fly the nominal flight: it ") + end.what());
  }
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(cases, 2); ++i) checked.emplace_back(i);
  try {
    together = FlySideBySide(flights, checked, should_stop);
  } catch (const ContainedEnd&) {
    checked.resize(1);  // such a case is left to whoever flies the campaign
    together = FlyAgain(flights, checked, should_stop);
  }
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (i > 0) {
      std::vector<Flown> again = FlyAgain(flights, {checked[i]}, should_stop);
      std::move(again.begin(), again.end(), std::back_inserter(alone));
    }
    if (alone.size() != i + 1 || together.size() != checked.size())
      throw PluginError("returned no valid result");
    const std::string difference = Difference(alone[i].history, together[i].history);
    if (difference.empty()) continue;
    throw PluginError(
        "is not deterministic: of " +
        (checked[i] ? "case " + std::to_string(*checked[i]) : std::string("the nominal flight")) +
        ", flown twice, " + difference);
  }
  std::vector<CaseResult> results;
  for (std::size_t i = 1; i < checked.size(); ++i) results.push_back(std::move(alone[i].result));
  return results;
}

}  // namespace

std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const StopCheck& should_stop) {
  const PluginLaw* const plugin = flights.model().autopilot().plugin.get();
  if (plugin == nullptr) return {};
  try {
    return CompareFlights(flights, cases, should_stop);
  } catch (const PluginError& error) {
    throw InputError("the control law " + plugin->config().name + " " + error.what());
  }
}

}  // namespace dispersa
