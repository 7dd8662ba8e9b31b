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

/// StageLaw of each lane's stage. P_n carries the flight's factors.
template <class T>
struct StageLawLanes {
  T kp_1_s2, kd_1_s;
  T p11, p12, p22;
  T pn_error, pn_rate;
  T gamma;
  T ki_1_s3;
  T filters[kFilterSections][5];  ///< DigitalSection's coefficients
};
template <class T>
DISPERSA_INLINE void SetLane(StageLawLanes<T>& s, int lane, const StageLaw& law, double pn_error_factor,
                             double pn_rate_factor) {
  SetLaneValues<T>(s, lane, law);
  Lane(s.pn_error, lane) *= pn_error_factor;
  Lane(s.pn_rate, lane) *= pn_rate_factor;
}

/// AxisState lane by lane.
template <class T>
struct AxisStateLanes : AxisMemory<T> {};
template <class T>
DISPERSA_INLINE void SetLane(AxisStateLanes<T>& m, int lane, const AxisState& s) {
  SetLaneValues<T>(m, lane, s);
}
template <class T>
DISPERSA_INLINE void ReadLane(const AxisStateLanes<T>& m, int lane, AxisState& s) {
  ReadLaneValues<T>(m, lane, s);
}

/// A tick of powered flight.
template <class T>
struct LawInput {
  const AxisConfig& config;
  double tick_s;
  const StageLawLanes<T>& stage;
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

template <class T>
DISPERSA_INLINE void SetLane(AxisOutput<T>& o, int lane, const AxisOutput<double>& from) {
  SetLaneValues<T>(o, lane, from);
}
/// The new value in the acting lanes, the old one in the others. `kAll`: every lane acts.
template <bool kAll, class T>
DISPERSA_INLINE T Kept(MaskOf<T> acting, T anew, T old) {
  if constexpr (kAll) return anew;
  return Select(acting, anew, old);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
