// dispersa: command line to command to exit code.
#pragma once

namespace dispersa {

/// The whole program; returns its exit code.
int RunProgram(int argc, char** argv);

}  // namespace dispersa
