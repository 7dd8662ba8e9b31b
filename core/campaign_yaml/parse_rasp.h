// Thrust curves of hobby and sounding motors, as RASP and its successors read them (.eng).
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// A map with the columns time_s and thrust_n of the text's only motor, and the masses of its header, which
/// are compared with the vehicle's. ';' begins a comment. Empty lines do not count. The first other line is
/// the header: name, diameter in mm, length in mm, delays, mass of propellant and of the whole in kg, maker.
/// Each further line is a time in s and a thrust in N. Times increase. Only the last thrust is 0. The point
/// at 0 s without thrust is added, if the first one is in the first tenth of the curve. A text of another
/// form is a problem and gives an absent node.
InputNode ParseRasp(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

}  // namespace dispersa
