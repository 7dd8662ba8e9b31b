// Included before every source of the copy that faults.py makes: which fault of faults.yaml this process has.
// Of the product only what starts dispersa-foreign names it, so that a fault is in that program too.
#pragma once

#include <cstdlib>

inline const int kDispersaFault =
    std::getenv("DISPERSA_FAULT") ? std::atoi(std::getenv("DISPERSA_FAULT")) : 0;

/// In a function, also one that is evaluated while it is compiled: there without a fault.
[[gnu::always_inline]] constexpr bool dispersa_fault(int number) {
  return !__builtin_is_constant_evaluated() && kDispersaFault == number;
}
/// In the value of a constant, which the compiler would take without the fault if it could evaluate this.
[[gnu::always_inline]] inline bool dispersa_fault_of_value(int number) { return kDispersaFault == number; }
