// A plug-in as the law of an axis.
#pragma once

#include "core/control/law.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A plug-in commands all its axes in one call a tick (PluginFlight), which has its memory: this hands on to
/// an axis what it commanded of it.
struct ForeignLaw {
  static void StartStage(const AxisConfig&, int stage, AxisState& memory) {
    if (stage == 0) ResetAxis(memory);
  }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisStateLanes<T>&) {
    out.command_rad_s2 = *in.foreign_rad_s2;
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
