// Standard output, where results go: a program that could not print them has not done its work.
#pragma once

#include <string_view>

#include "services/program/exit_code.h"

namespace dispersa {

/// Before anything is opened: whichever of the three standard streams is closed stays taken, else the next
/// file that is opened would get its number, and what is printed. Printing to it is an error all the same.
void HoldStandardStreams();

/// Prints all that a program has to say. What it ends with: kExitDone, or kExitIncomplete if that did not
/// arrive.
ExitCode PrintAndEnd(std::string_view text);

/// What a program ends with that has printed all it has to: `code`, or worse if that did not arrive.
ExitCode EndOutput(ExitCode code);
/// Says that it did not arrive, and why by `error`, an errno or 0. Returns kExitIncomplete.
ExitCode EndLostOutput(int error);
/// True if what was printed did not arrive: whatever was thrown since then was thrown for this.
bool IsOutputLost();

}  // namespace dispersa
