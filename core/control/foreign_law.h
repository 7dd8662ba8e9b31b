// A plug-in as the law of an axis.
#pragma once

#include "core/control/law.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A plug-in commands all its axes in one call a tick (PluginFlight), and keeps its own memory. This law
/// passes its command on to one axis.
struct ForeignLaw {
  static void StartStage(const AxisConfig&, int stage, AxisState& memory) {
    if (stage == 0) ResetAxis(memory);
  }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisMemory<T>&) {
    out.command_rad_s2 = *in.foreign_rad_s2;
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
