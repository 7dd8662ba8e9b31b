// Whether a vehicle that does not contradict itself could be one: what its numbers imply, against physics and
// against launchers that flew. A vehicle of kilograms typed for tons flies as well as any other in a
// computer.
//
// Each check is a row of a table in plausibility.cc: what is implied, what is possible, what is usual, and
// from where that is known. Beyond what is possible the file is refused; beyond what is usual it is warned
// about, once. Centres of gravity inside the body and inertias that a body can have follow from masses being
// tubes between the nose and the stage's end, which Problems() demands; where a file states inertias, its
// reader checks them (flight/scenario.cc).
#pragma once

#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

struct PlausibilityFinding {
  std::string path;     ///< of the value to look at first
  std::string message;  ///< what it implies
  std::string allowed;  ///< what is possible, or usual, and from where that is known
  bool impossible = false;
};

/// Of a vehicle without Problems().
std::vector<PlausibilityFinding> Plausibility(const Vehicle& vehicle);

}  // namespace dispersa
