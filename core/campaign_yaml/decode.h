// Trees with everything inlined to the engine's structs.
//
// `path` is the tree's own in its file: empty when it is a whole file, e.g. "vehicle" when it is inlined.
// A result is complete only if no problem was recorded.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/scenario.h"
#include "core/input/fields.h"
#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// `warnings`, if given, receives what is possible but unusual (core/vehicle/plausibility.h).
Vehicle DecodeVehicle(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                      std::vector<InputProblem>* warnings = nullptr);
void DescribeVehicleFile(Fields& fields, Vehicle& vehicle);
/// A control law written in Python is named in a file, not contained: to fly it, it must be here
/// (OfferedLaw).
enum class PythonLaws { kMustBeHere, kMayBeAbsent };

void DescribeAutopilotFile(Fields& fields, AutopilotConfig& autopilot, const Fields::ReadNode& plugin);
/// `stages`: of the vehicle that it flies, 0 if that is unknown (then nothing is checked against it).
AutopilotConfig DecodeAutopilot(const InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems,
                                PythonLaws laws = PythonLaws::kMustBeHere);
/// An autopilot's `plugin`, its library inlined; what the library says of itself is asked in a child process.
PluginConfig DecodePlugin(const InputNode& node, const std::string& path, PythonLaws laws,
                          std::vector<InputProblem>& problems);
Scenario DecodeScenario(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems);
void DescribeScenarioFile(Fields& fields, Scenario& scenario);
Reference DecodeReference(const InputNode& node, const std::string& path,
                          std::vector<InputProblem>& problems);
void DescribeReferenceFile(Fields& fields, Reference& reference);

}  // namespace dispersa
