// The parts of the extension module.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/campaign_yaml/load.h"

namespace dispersa {

/// Campaigns from files and texts, their draws and flights.
void AddCampaigns(pybind11::module_& module);
/// Runs, result folders, comparisons, margins, references.
void AddResults(pybind11::module_& module);

/// A list of (file, line, column, path, message, allowed).
pybind11::list ProblemsOf(const std::vector<InputProblem>& problems);

/// A file, or a text that stands in for it.
inline InputSource SourceOf(const std::string& name, const std::optional<std::string>& text) {
  return text ? InputSource(name, *text) : InputSource(name);
}

}  // namespace dispersa
