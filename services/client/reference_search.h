// The trajectory that reaches a campaign's target orbit, and the files that it becomes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/campaign_yaml/load.h"
#include "core/trajectory/check_flight.h"
#include "core/trajectory/optimize.h"
#include "services/client/observer.h"

namespace dispersa {

/// Options of the search for this input. The result does not depend on the threads.
TrajectoryOptions SearchOptions(const OptimizationInput& input, int threads);

/// The user's trajectory problem may ask for options out of their ranges.
template <typename Function>
auto SearchOrInputError(const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("the optimisation problem cannot be solved as given: ") + error.what());
  }
}

/// The nominal flight with six degrees of freedom under the input's autopilot. Nothing without an autopilot.
std::optional<CheckFlight> FlyReference(const OptimizationInput& input, const Reference& reference);

/// {outcome, end_time_s, reason}
nlohmann::ordered_json CheckFlightJson(const CheckFlight& flight);

struct FoundReference {
  OptimizationResult result;         ///< named after the campaign, and the vehicle that it is for
  std::optional<CheckFlight> check;  ///< FlyReference, if the target is reached

  /// Also by the check flight, if there is one.
  bool reached() const { return result.reached && !(check && !check->completed()); }
  /// How far the search got, or why the check flight was lost; empty if the target is reached.
  std::string Statement() const;
};
/// A search that misses its target has still found something, which says so itself. Throws InputError,
/// Interrupted.
FoundReference FindReference(const OptimizationInput& input, int threads, Observer& observer);

/// Whether the reference, and the files beside it, can be written. As RequireWritableFile.
void RequireWritableReference(const std::string& option, const std::filesystem::path& file);
/// Writes the reference, its time history beside it as .csv, and figures and tables as .html.
void WriteFoundReference(const FoundReference& found, const std::filesystem::path& file);

/// Schema "dispersa/optimize/1". `file` is the place of the reference.
nlohmann::ordered_json FoundReferenceJson(const Vehicle& vehicle, const FoundReference& found,
                                          const std::string& file);

}  // namespace dispersa
