// How many threads a command takes.
#pragma once

#include <algorithm>
#include <thread>

namespace dispersa {

/// As many as asked for; with 0 as the processor has.
inline int ThreadsOrAll(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace dispersa
