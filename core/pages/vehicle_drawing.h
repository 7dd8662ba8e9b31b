// A drawing of a vehicle to scale, as its file describes it. It shows mistakes that a table of numbers hides.
#pragma once

#include <string>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// A self-contained SVG document with a scale in metres, the same for both axes. It shows the mould line,
/// stages, grains with their bores, masses of the structure, hinges of the nozzles and sensors. It also shows
/// the centres of gravity of each stack, full and empty. Precondition: no Problems().
std::string VehicleDrawing(const Vehicle& vehicle);
/// The same without words and scale, for a page that has its style.
std::string VehicleSketch(const Vehicle& vehicle);

}  // namespace dispersa
