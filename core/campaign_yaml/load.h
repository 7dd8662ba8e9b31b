// From the user's YAML files to the structs of the engine, and back for references and autopilots.
//
// The schema of every kind of file is in README.md beside this header. A function that loads reads all files
// that its argument refers to, and throws one InputError with every problem of all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/scenario.h"
#include "core/input/input_error.h"

namespace dispersa {

/// A file, or a text that stands in for it: names in the text are relative to where the file would be.
struct InputSource {
  InputSource(const char* file) : name(file) {}
  InputSource(std::string file) : name(std::move(file)) {}
  InputSource(std::string file, std::string yaml_text) : name(std::move(file)), text(std::move(yaml_text)) {}

  std::string name;
  std::optional<std::string> text = {};  ///< none: what the file holds
};

/// Values of the command line that replace the file's before anything is checked or hashed.
struct CampaignOverrides {
  std::optional<std::uint64_t> cases = {};
  std::optional<std::uint64_t> seed = {};
  std::optional<std::string> autopilot = {};  ///< a file, relative to the working directory
};

/// The campaign of a file, to be flown: it must have a `reference`, not an `optimize` block. `warnings`, if
/// given, receives what looks wrong but is legal (a reference that was found for another vehicle, a vehicle
/// like none that is known).
Campaign LoadCampaign(const InputSource& source, const CampaignOverrides& overrides = {},
                      std::vector<InputProblem>* warnings = nullptr);
/// The campaign of a canonical text (Campaign::canonical_yaml, a result folder's campaign.yaml), in which
/// everything is inlined. `display_name` stands for the file in messages. The same campaign, the same
/// canonical text, the same ids as LoadCampaign of the original.
Campaign ParseCampaign(const std::string& yaml_text, const std::string& display_name);

/// Reads a result folder's campaign.yaml without flying it. A control law in Python may be missing.
Campaign ReadFlownCampaign(const InputSource& source);

/// A campaign's part for `optimize`: the trajectory problem in its `optimize` block, or that of its
/// reference.
struct OptimizationInput {
  std::string name;  ///< of the campaign
  Vehicle vehicle;
  std::string vehicle_sha256;  ///< of the canonical vehicle
  TrajectoryProblem problem;
  double tick_s = 0.01;  ///< of the campaign's autopilot, if it has one: burnout is detected on ticks
  /// Of the campaign with its autopilot, without a reference; empty if it has no autopilot.
  std::string canonical_yaml;
};
/// `seed` replaces the problem's.
OptimizationInput LoadOptimization(const InputSource& source, std::optional<std::uint64_t> seed = {},
                                   std::vector<InputProblem>* warnings = nullptr);

/// The campaign that flies a reference that was found, with the autopilot and nothing else of the input's
/// campaign. None if that has no autopilot.
std::optional<Campaign> CampaignOf(const OptimizationInput& input, const Reference& reference);

Vehicle LoadVehicle(const InputSource& source, std::vector<InputProblem>* warnings = nullptr);
AutopilotConfig LoadAutopilot(const InputSource& source);
Reference LoadReference(const InputSource& source);
Scenario LoadScenario(const InputSource& source);
/// True if the file is YAML with `schema: dispersa/scenario/1`. False for a file that cannot be read.
bool IsScenarioFile(const std::string& path);

/// YAML text of a reference, with angles in degrees and lengths in km. A number is the shortest text that
/// reads back to the same bits. A few radian values are no double's worth of degrees and become the nearest
/// value that is. So the text of a reference may differ from x in the last bit. Writing and reading
/// again changes nothing more, neither value nor text.
std::string WriteReference(const Reference& reference);

/// YAML text of an autopilot, with the blocks that its laws read. Numbers as in WriteReference.
std::string WriteAutopilot(const AutopilotConfig& autopilot);

/// The result of checking a file of any kind. Its `schema` names the kind.
struct FileCheck {
  std::vector<InputProblem> errors;    ///< all errors (empty: the file is valid)
  std::vector<InputProblem> warnings;  ///< of a valid one
  bool is_vehicle = false;
  std::optional<Vehicle> vehicle;  ///< of a valid vehicle or campaign
};
FileCheck CheckFile(const InputSource& source);

}  // namespace dispersa
