// Flights with a plug-in as control law. They are flown in child processes, so that nothing in the plug-in
// ends this process.
#pragma once

#include "core/cases/flights_here.h"

namespace dispersa {

/// FlightsHere::Fly in a child. Throws PluginError, ContainedEnd.
CaseResult FlyContained(const FlightsHere& flights, const FlightInputs& inputs, std::uint64_t case_index,
                        History* history, Scheme scheme);
/// FlightsHere::FlyCases in child processes that fly some cases each. Cases that a child did not fly before
/// it ended are flown again, each in a child of its own. A case that ends this child too is quarantined.
void FlyContained(const FlightsHere& flights, CaseQueue& queue);

}  // namespace dispersa
