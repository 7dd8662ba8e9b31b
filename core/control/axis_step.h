// One axis of the autopilot of W flights side by side (core/math/lanes.h), one tick: from the attitude error
// and its rate to an angular acceleration, under any control law. Signs as in axis_controller.h.
#pragma once

#include "core/control/law_choice.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
DISPERSA_INLINE AxisTelemetry TelemetryOf(const AxisConfig& config, const AxisOutput<T>& o,
                                          const AxisMemory<T>& m, int lane) {
  AxisTelemetry t;
  const double bound = config.adaptation.projection_bound_rad_s2;
  for (int i = 0; i < kFuzzyRules; ++i)
    t.projected |= bound > 0.0 && Abs(Lane(m.departure_rad_s2[i], lane)) >= bound;
  t.command_rad_s2 = Lane(o.command_rad_s2, lane);
  t.adaptation_norm = Sqrt(Lane(o.departure_norm2, lane));
  t.v = Lane(o.v, lane);
  t.v_rate_sign = Lane(o.v_rate_sign, lane);
  t.total_gain = Lane(m.total_gain, lane);
  t.rules_fired = static_cast<std::uint32_t>(ToBits(Lane(m.rules_fired, lane)));
  t.frozen = Lane(o.frozen, lane) > 0.0;
  return t;
}

/// `count` sections in series, transposed direct form II: two values of memory each.
template <bool kAll, class T>
DISPERSA_INLINE T Filter(int count, const DigitalSectionOf<T>* sections, MaskOf<T> acting, T x,
                         T (*memory)[2]) {
  for (int i = 0; i < count; ++i) {
    const DigitalSectionOf<T>& c = sections[i];
    T* m = memory[i];
    const T y = Fma(c.b0, x, m[0]);
    const T first = Fma(c.b1, x, Fma(-c.a1, y, m[1]));
    const T second = Fma(c.b2, x, -c.a2 * y);
    m[0] = Kept<kAll>(acting, first, m[0]);
    m[1] = Kept<kAll>(acting, second, m[1]);
    x = y;
  }
  return x;
}

/// One tick of the acting lanes. The other lanes keep their memory. `foreign_rad_s2`: the command of a
/// plug-in or of Python, else null. `is_reported`: V and what the law has learnt are read afterwards.
template <bool kAll, class T>
DISPERSA_INLINE void StepAxis(const AxisConfig& config, double tick_s, const StageLawOf<T>& stage,
                              MaskOf<T> acting, T error, T rate, const T* foreign_rad_s2, bool is_reported,
                              AxisMemory<T>& memory, AxisOutput<T>& out) {
  out.command_rad_s2 = out.departure_norm2 = out.frozen = out.v = out.v_rate_sign = T(0.0);
  if (is_reported || config.adaptation.supervisory_bound > 0.0) {
    out.v = T(0.5) *
            Fma(stage.p11 * error, error, Fma(T(2.0) * stage.p12 * error, rate, stage.p22 * rate * rate));
    out.v_rate_sign =
        Select(out.v > memory.previous_v, T(1.0), Select(out.v < memory.previous_v, T(-1.0), T(0.0)));
    memory.previous_v = Kept<kAll>(acting, out.v, memory.previous_v);
  }
  const LawInput<T> input{config, tick_s, stage, acting, error, rate, foreign_rad_s2, is_reported};
  WithLaw(
      config.law, [&](auto law) __attribute__((always_inline)) {
        decltype(law)::template Step<kAll>(input, out, memory);
      });
  const int sections = static_cast<int>(config.filters.size());
  out.command_rad_s2 = Filter<kAll>(sections, stage.filters, acting, out.command_rad_s2, memory.filters);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
