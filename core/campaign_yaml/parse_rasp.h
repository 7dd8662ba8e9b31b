// Thrust curves of hobby and sounding motors, as RASP and its successors read them (.eng).
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// A map with the columns time_s and thrust_n of the one motor that the text holds. Lines that begin with ';'
/// and empty ones do not count. The first other line is the header: name, diameter in mm, length in mm,
/// delays, kilograms of propellant and in all, maker; it is checked, and nothing of it is used. The lines
/// after it are pairs of a time in s and a thrust in N, of increasing time, up to the one and only thrust of
/// 0. Ignition, at 0 s without thrust, goes without saying. A text of another form is a problem and an absent
/// node.
InputNode ParseRasp(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

}  // namespace dispersa
