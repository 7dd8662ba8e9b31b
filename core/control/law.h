// Input and output of one axis' control law: those of control_law.h, which plug-ins have, for W flights side
// by side (core/math/lanes.h).
//
// A law is a struct without data. It has the functions of control_law.h:
//   StartStage(config, stage, memory)   an ignition: the memory is kept or begins anew
//   Step<kAll>(input, output, memory)   a tick: the commands of the acting lanes; `kAll`: every lane acts
// All its state is in the memory. It changes no lane that does not act.
#pragma once

#include "core/control/axis_controller.h"
#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A tick of powered flight.
template <class T>
struct LawInput {
  const AxisConfig& config;
  double tick_s;
  const StageLawOf<T>& stage;  ///< P_n carries the flight's factors
  MaskOf<T> acting;
  T error_rad, rate_rad_s;  ///< e and its rate
  const T* foreign_rad_s2;  ///< the command of a plug-in for the axis, if the law is one
  bool is_reported;         ///< the learnt values are read afterwards
};

/// A law's output: AxisTelemetry lane by lane. V is set beforehand, the rest begins at zero.
template <class T>
struct AxisOutput {
  T command_rad_s2;  ///< u
  T v, v_rate_sign;
  T departure_norm2;  ///< squared adaptation norm
  T frozen;
};
/// The new value in the acting lanes, the old one in the others. `kAll`: every lane acts.
template <bool kAll, class T>
DISPERSA_INLINE T Kept(MaskOf<T> acting, T anew, T old) {
  if constexpr (kAll) return anew;
  return Select(acting, anew, old);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
