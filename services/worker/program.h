// dispersa-worker: flies cases for a coordinator.
#pragma once

namespace dispersa {

/// The whole program. Returns its exit code.
int RunWorker(int argc, char** argv);

}  // namespace dispersa
