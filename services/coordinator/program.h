// dispersa-coordinator: serves the campaigns of clients, or one campaign, to the workers that come.
#pragma once

namespace dispersa {

/// The whole program; returns its exit code.
int RunCoordinator(int argc, char** argv);

}  // namespace dispersa
