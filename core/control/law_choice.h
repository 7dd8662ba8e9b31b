// The control law of an axis. Only here does code depend on which law it is.
#pragma once

#include "core/control/augmented_law.h"
#include "core/control/foreign_law.h"
#include "core/control/fuzzy_law.h"
#include "core/control/linear_laws.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Calls `use` with the law of this name.
template <class Use>
DISPERSA_INLINE void WithLaw(ControlLaw law, Use&& use) {
  switch (law) {
    case ControlLaw::kAdaptiveFuzzy:
    case ControlLaw::kFrozenFuzzy:
      return use(FuzzyLaw{});
    case ControlLaw::kPd:
      return use(PdLaw{});
    case ControlLaw::kPid:
      return use(PidLaw{});
    case ControlLaw::kPdAac:
    case ControlLaw::kPidAac:
      return use(AugmentedLaw{});
    case ControlLaw::kPlugin:
      return use(ForeignLaw{});
  }
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
