// Errors as Python's exceptions, in Python's words.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <vector>

#include "core/input/input_error.h"

namespace dispersa {

/// A list of (file, line, column, path, message, allowed).
pybind11::list ProblemsOf(const std::vector<InputProblem>& problems);

/// Turns an error with which a command would end into the exception of dispersa.errors for its exit code.
void Translate(std::exception_ptr problem);

}  // namespace dispersa
