// dispersa fly with a scenario file.
#pragma once

#include <string>

#include "core/dynamics/integrator.h"
#include "services/cli/command.h"

namespace dispersa {

/// Flies the scenario, writes its history if `history` is not empty, and prints outcome and final state.
ExitCode FlyScenarioFile(const std::string& path, Scheme scheme, const std::string& history,
                         const GlobalOptions& global);

}  // namespace dispersa
