// How many threads a command takes.
#pragma once

#include <sched.h>

namespace dispersa {

/// The cores that this process may use: with an affinity mask fewer than the processor has.
inline int UsableCores() {
  cpu_set_t usable;
  CPU_ZERO(&usable);
  return sched_getaffinity(0, sizeof usable, &usable) == 0 ? CPU_COUNT(&usable) : 1;
}

/// `asked` threads, or with 0 the usable cores.
inline int ThreadsOrAll(int asked) { return asked > 0 ? asked : UsableCores(); }

}  // namespace dispersa
