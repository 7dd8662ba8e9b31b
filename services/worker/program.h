// dispersa-worker: flies cases for a coordinator.
#pragma once

namespace dispersa {

/// The whole program; returns its exit code.
int RunWorker(int argc, char** argv);

}  // namespace dispersa
