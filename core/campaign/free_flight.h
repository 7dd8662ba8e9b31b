// What stands for reference and autopilot in flights that nothing controls: the attitude on the rail, and
// ticks that are the steps of the integration.
#pragma once

#include "core/campaign/campaign.h"

namespace dispersa {

/// Sets both. Precondition: a vehicle with a rail, and course.is_controlled is false.
void SetFreeFlight(Campaign& campaign);

/// Throws InputError for a campaign whose flights nothing controls. `what` names what needs an autopilot:
/// "margins".
void RequireControl(const Campaign& campaign, const char* what);

/// Contradictions between a vehicle and what should control it. Paths are keys of the campaign's `flight`.
std::vector<StructProblem> ControlProblems(const Vehicle& vehicle, const FlightCourse& course);

}  // namespace dispersa
