// Flights whose control law is a plug-in: flown in child processes, so that nothing that the plug-in does
// ends this one.
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
