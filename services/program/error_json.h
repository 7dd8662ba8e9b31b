// Errors for programs that read them: with --json, one object on standard output. The text also goes to
// stderr.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "core/input/input_error.h"
#include "services/program/exit_code.h"

namespace dispersa {

/// {file, line, column, path, message, allowed}; 0 and "" for missing parts.
nlohmann::ordered_json ProblemJson(const InputProblem& problem);

/// Prints {schema: "dispersa/error/1", code, errors}. A command that fails has printed nothing else.
void PrintErrorJson(ExitCode code, const std::vector<InputProblem>& problems);
/// Prints one problem without a place.
void PrintErrorJson(ExitCode code, const std::string& message);

}  // namespace dispersa
