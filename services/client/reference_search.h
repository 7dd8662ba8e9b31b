// The trajectory that reaches a campaign's target orbit, and the files that it becomes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/campaign_yaml/load.h"
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

/// Injection errors of the nominal flight with six degrees of freedom under the input's autopilot. Nothing
/// without an autopilot, or when the flight does not complete.
std::optional<OrbitErrors> FlyReference(const OptimizationInput& input, const Reference& reference);

struct FoundReference {
  OptimizationResult result;         ///< named after the campaign, and the vehicle that it is for
  std::optional<OrbitErrors> flown;  ///< FlyReference, if the target is reached
};
/// A search that misses its target has still found something, which says so itself. Throws InputError,
/// Interrupted.
FoundReference FindReference(const OptimizationInput& input, int threads, Observer& observer);

/// Whether the reference, and the files beside it, can be written. As RequireWritableFile.
void RequireWritableReference(const std::string& option, const std::filesystem::path& file);
/// Writes the reference, its time history beside it as .csv, and figures and tables as .html.
void WriteFoundReference(const FoundReference& found, const std::filesystem::path& file);

/// Schema "dispersa/optimize/1". `file` is the place of the reference.
nlohmann::ordered_json FoundReferenceJson(const Vehicle& vehicle, const OptimizationResult& result,
                                          const std::string& file);

}  // namespace dispersa
