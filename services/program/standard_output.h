// Standard output, where results go: a program that could not print them has not done its work.
#pragma once

#include <string_view>

#include "services/program/exit_code.h"

namespace dispersa {

/// Call before any file is opened.
/// - A closed standard stream stays reserved. Otherwise the next opened file would get its number, and the
///   printed text. Printing to it is still an error.
/// - A write beyond the limit of a file's size (`ulimit -f`) becomes an error, and does not end the process.
void PrepareFiles();

/// Prints a program's whole output. Returns kExitDone, or kExitIncomplete if it did not arrive.
ExitCode PrintAndEnd(std::string_view text);

/// Exit code of a program that has printed everything: `code`, or a worse one if the output did not arrive.
ExitCode EndOutput(ExitCode code);
/// Says that it did not arrive, and why by `error`, an errno or 0. Returns kExitIncomplete.
ExitCode EndLostOutput(int error);
/// True if output was lost. Any exception since then was caused by it.
bool IsOutputLost();

}  // namespace dispersa
