// Proportional and derivative control, with and without an integral.
#pragma once

#include "core/control/law.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Remembers nothing.
struct PdLaw {
  static void StartStage(const AxisConfig&, int stage, AxisState& memory) {
    if (stage == 0) ResetAxis(memory);
  }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisMemory<T>&) {
    out.command_rad_s2 = Fma(in.stage.kp_1_s2, in.error_rad, in.stage.kd_1_s * in.rate_rad_s);
  }
};

/// Proportional, derivative and integral of the error. The command uses the integral before the step, as the
/// rules' does what they have learnt.
struct PidLaw {
  static void StartStage(const AxisConfig& config, int stage, AxisState& memory) {
    if (stage == 0 || config.integral.reset_at_ignition) ResetAxis(memory);
  }

  template <bool kAll, class T>
  DISPERSA_INLINE static void Step(const LawInput<T>& in, AxisOutput<T>& out, AxisMemory<T>& memory) {
    const T before = memory.integral_rad_s2;
    const T bound(in.config.integral.bound_rad_s2 > 0.0 ? in.config.integral.bound_rad_s2 : 1e300);
    const T after = Clamp(Fma(T(in.tick_s) * in.stage.ki_1_s3, in.error_rad, before), -bound, bound);
    const auto held = memory.saturation * in.error_rad > T(0.0);
    memory.integral_rad_s2 = Kept<kAll>(in.acting, Select(held, before, after), before);
    out.command_rad_s2 = Fma(in.stage.kp_1_s2, in.error_rad, Fma(in.stage.kd_1_s, in.rate_rad_s, before));
  }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
