// The flights of `dispersa run` in worker processes: a coordinator in this process, workers as its children.
#pragma once

#include <filesystem>

#include "services/client/campaign_run.h"

namespace dispersa {

/// Flies with worker processes of this program, dispersa-worker, over a private DDS domain of the loopback
/// interface. The workers die with this process.
FlyWithWorkers WorkersOfProgram(const std::filesystem::path& program);

}  // namespace dispersa
