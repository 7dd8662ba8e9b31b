// Reads trees into the engine's structs. Named files are already replaced by their contents.
//
// `path` is the tree's own path in its file: empty for a whole file, "vehicle" for an inlined vehicle. A
// result is complete only if no problem was recorded.
#pragma once

#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/input/field_reader.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// `warnings`, if given, receives values that are possible but unusual (core/vehicle/plausibility.h).
Vehicle DecodeVehicle(InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                      FileSource* files, std::vector<InputProblem>* warnings = nullptr);

/// A control law written in Python is named in a file, not contained: to fly it, it must be here
/// (OfferedLaw).
enum class PythonLaws { kMustBeHere, kMayBeAbsent };
/// `stages` is the number of stages of the vehicle, 0 if unknown (then nothing is checked against it). A
/// plug-in describes itself, in a child process.
AutopilotConfig DecodeAutopilot(InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems, FileSource* files,
                                PythonLaws laws = PythonLaws::kMustBeHere);

/// Decodes a file that only its description checks.
template <class T, class F>
T DecodeFile(InputNode& node, const std::string& path, std::vector<InputProblem>& problems, FileSource* files,
             F describe) {
  T value;
  ReadFields(node, path, problems, files, [&](Fields& fields) { describe(fields, value); });
  return value;
}

}  // namespace dispersa
