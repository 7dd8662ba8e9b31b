// Plausibility of a vehicle: numbers that its file implies, compared with physics and with launchers that
// flew. A vehicle of kilograms typed for tons flies as well as any other in a computer.
//
// Each check is a row of a table in plausibility_stage.cc, plausibility_air.cc or plausibility_vehicle.cc:
// the implied number, its possible and usual ranges, and their source. Beyond the possible range the file is
// refused. Beyond the usual range there is one warning. Problems() makes sure that centres of gravity are
// inside the body and inertias are possible: masses are tubes between the nose and the stage's end. Where a
// file states inertias, its reader checks them (flight/scenario.cc).
#pragma once

#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// `path` is the value to look at first, `message` its implication, `allowed` the possible or usual range
/// with its source.
struct PlausibilityFinding : StructProblem {
  bool impossible = false;
};

/// Precondition: a vehicle without Problems().
std::vector<PlausibilityFinding> Plausibility(const Vehicle& vehicle);

}  // namespace dispersa
