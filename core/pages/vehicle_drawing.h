// A vehicle as its file describes it, drawn to scale: what a table of numbers hides, a look shows.
#pragma once

#include <string>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// An SVG document of its own: mould line, stages, grains with their bores, masses of the structure, hinges
/// of the nozzles, sensors, centres of gravity of each stack full and empty, a scale in metres. Both axes
/// have one scale. Precondition: no Problems().
std::string VehicleDrawing(const Vehicle& vehicle);

}  // namespace dispersa
