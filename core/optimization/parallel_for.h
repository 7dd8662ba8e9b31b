// A loop over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace dispersa {

/// Calls body(0) ... body(count - 1), each once, on up to `threads` threads, including the caller's. The
/// items are handed out one by one, since they may take very different times. So body(i) must depend on
/// nothing but i. If bodies throw, the exception of the lowest index is thrown after all have run.
void ParallelFor(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& body);

}  // namespace dispersa
