// Orders to fly, as bytes for a process of dispersa-foreign, and their answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cases/flights_here.h"
#include "core/containment/contained.h"

namespace dispersa {

/// A flight, and its history: the answer is a result with it.
struct FlownOnce {
  CaseResult result;
  std::vector<double> history;  ///< History::values; empty if none was wanted
};

/// One flight of any inputs: FlownOnce. `history_step_s`: none, no history.
std::string OrderFlight(const FlightInputs& inputs, std::uint64_t case_index,
                        std::optional<double> history_step_s, Scheme scheme);
/// Cases side by side as FlyCases does: a FlownOnce each, in the order in which they end.
std::string OrderCases(const std::vector<std::uint64_t>& cases);
/// Cases side by side with a history at every tick, in this order. None is the nominal flight.
std::string OrderSideBySide(const std::vector<std::optional<std::uint64_t>>& cases);

/// Flies an order in this process.
void CarryOut(const FlightsHere& flights, const std::string& order, const Say& say);
/// One message of an answer. A law may have written it: throws ContainedEnd if it is no result of these
/// flights.
FlownOnce TakeAnswer(const FlightsHere& flights, const std::string& message);

}  // namespace dispersa
