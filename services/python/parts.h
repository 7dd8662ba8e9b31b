// The parts of the extension module.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "core/campaign_yaml/load.h"
#include "services/client/campaign_run.h"

namespace dispersa {

/// Campaigns from files and texts, their draws and flights.
void AddCampaigns(pybind11::module_& module);
/// Runs, result folders, comparisons, margins, references.
void AddResults(pybind11::module_& module);
/// Runs by a coordinator; nothing in a build without the service.
void AddService(pybind11::module_& module);

/// Flights in processes of this program; none in a build without the service.
FlyWithWorkers WorkersOfProgramAt(const std::string& worker_program);

/// A file, or a text that stands in for it.
inline InputSource SourceOf(const std::string& name, const std::optional<std::string>& text) {
  return text ? InputSource(name, *text) : InputSource(name);
}

}  // namespace dispersa
