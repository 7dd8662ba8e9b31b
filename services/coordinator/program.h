// dispersa-coordinator: serves the campaigns of clients, or one campaign, to the workers that come.
#pragma once

namespace dispersa {

/// The whole program. Returns its exit code.
int RunCoordinator(int argc, char** argv);

}  // namespace dispersa
