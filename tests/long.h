// Whether a test has the time of `tests/run --long`.
#pragma once

#include <cstdlib>

namespace dispersa {

/// Set by the entries of ctest with the label `long` that run suites of the usual programs at their full
/// length.
inline bool IsLong() { return std::getenv("DISPERSA_LONG") != nullptr; }

}  // namespace dispersa
