#include "core/cases/plugin_check.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "core/flight/flight_model.h"
#include "core/flight/lane_engine.h"
#include "core/input/input_error.h"

namespace dispersa {
namespace {

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
std::vector<FlownOnce> FlyAgain(const CampaignFlights& flights,
                                const std::vector<std::optional<std::uint64_t>>& cases,
                                const StopCheck& should_stop) {
  try {
    return flights.FlyOrdered(OrderSideBySide(cases), should_stop);
  } catch (const ContainedEnd& end) {
    throw PluginError("is not deterministic: the same flight ended well once, and again it " +
                      std::string(end.what()));
  }
}

// Each once alone and once beside the others. Returns the cases' results.
std::vector<CaseResult> CompareFlights(const CampaignFlights& flights, std::uint64_t cases,
                                       const StopCheck& should_stop) {
  std::vector<std::optional<std::uint64_t>> checked = {std::nullopt};
  std::vector<FlownOnce> alone, together;
  try {
    alone = flights.FlyOrdered(OrderSideBySide(checked), should_stop);
  } catch (const ContainedEnd& end) {
    throw PluginError(std::string("cannot fly the nominal flight: it ") + end.what());
  }
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(cases, 2); ++i) checked.emplace_back(i);
  try {
    together = flights.FlyOrdered(OrderSideBySide(checked), should_stop);
  } catch (const ContainedEnd&) {
    checked.resize(1);  // such a case is left to whoever flies the campaign
    together = FlyAgain(flights, checked, should_stop);
  }
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (i > 0) {
      std::vector<FlownOnce> again = FlyAgain(flights, {checked[i]}, should_stop);
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

const std::string kTheLaw = "the control law ";

}  // namespace

bool IsOfTheLaw(const std::string& reason) { return reason.starts_with(kTheLaw); }

std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const StopCheck& should_stop, std::chrono::seconds limit) {
  const PluginLaw* const plugin = flights.model().autopilot().plugin.get();
  if (plugin == nullptr) return {};
  const auto latest = std::chrono::steady_clock::now() + limit;
  bool is_late = false;
  const auto stop = [&] {
    is_late = std::chrono::steady_clock::now() > latest;
    return is_late || (should_stop && should_stop());
  };
  try {
    return CompareFlights(flights, cases, stop);
  } catch (const Interrupted&) {
    if (!is_late) throw;
    throw InputError(kTheLaw + plugin->config().name + " is too slow: its check flights took more than " +
                     std::to_string(limit.count()) + " s");
  } catch (const PluginError& error) {
    throw InputError(kTheLaw + plugin->config().name + " " + error.what());
  }
}

}  // namespace dispersa
