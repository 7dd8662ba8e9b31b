// Included before every source of the copy that faults.py makes: which fault of faults.yaml this process has.
// No source of dispersa names it.
#pragma once

#include <cstdlib>

inline const int kDispersaFault =
    std::getenv("DISPERSA_FAULT") ? std::atoi(std::getenv("DISPERSA_FAULT")) : 0;

[[gnu::always_inline]] constexpr bool dispersa_fault(int number) {
  return !__builtin_is_constant_evaluated() && kDispersaFault == number;
}
