// dispersa: command line to command to exit code.
#pragma once

namespace dispersa {

struct Service;

/// The whole program. Returns its exit code. `service`: none of a build without it (command.h).
int RunProgram(int argc, char** argv, const Service* service);

}  // namespace dispersa
