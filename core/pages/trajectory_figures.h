// The flight program and the trajectory that it produces, as figures.
#pragma once

#include <string>
#include <vector>

#include "core/trajectory/ascent.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Programmed angle of attack over the whole flight and over the pitch-over, stages and coast marked:
/// <figure>s.
std::string FlightProgramFigures(const FlightProgram& program, const std::vector<AscentSample>& history);

/// Pitch, height, velocity and inertial flight path angle over time: <figure>s.
std::string ReferenceFigures(const std::vector<AscentSample>& history);

/// The time history for other tools; the header names the columns with their units.
std::string AscentCsv(const std::vector<AscentSample>& history);

}  // namespace dispersa
