// dispersa: command line to command to exit code.
#pragma once

namespace dispersa {

/// The whole program. Returns its exit code.
int RunProgram(int argc, char** argv);

}  // namespace dispersa
