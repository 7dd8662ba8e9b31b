// The flight program and the trajectory that it produces, as figures.
#pragma once

#include <string>
#include <vector>

#include "core/trajectory/ascent.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// <figure> elements of the programmed angle of attack, over the whole flight and over the pitch-over. Stages
/// and coasts are marked.
std::string FlightProgramFigures(const FlightProgram& program, const std::vector<AscentSample>& history);

/// <figure> elements of pitch, altitude, velocity, inertial flight path angle, dynamic pressure, apogee and
/// perigee over time.
std::string ReferenceFigures(const std::vector<AscentSample>& history);

/// What the end of an ascent is: "injection" if its perigee is above the ground or no history tells,
/// otherwise "end of the ascent".
const char* AscentEndWords(const std::vector<AscentSample>& history);

/// Begin and end of each burn, the largest dynamic pressure and the end, with the state there. A burn
/// has thrust: at least 0.5 g along the axis. Times are those of samples. Empty without a history.
std::string AscentEventsTable(const std::vector<AscentSample>& history);

/// The time history as CSV for other tools. The header names the columns with their units.
std::string AscentCsv(const std::vector<AscentSample>& history);

}  // namespace dispersa
