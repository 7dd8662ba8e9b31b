// The attitude loop of W flights side by side (core/math/lanes.h): the one source of StepGimbals and
// StepThrusters.
#pragma once

#include "core/control/autopilot.h"
#include "core/control/axis_step.h"
#include "core/control/law_schedule.h"
#include "core/control/reaction_control.h"
#include "core/math/lane_vector.h"
#include "core/math/row_memory.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// The loop's knowledge of each lane's stage.
template <class T>
struct GimbalLoop {
  StageLawOf<T> axes[kAxes];   ///< P_n carries the flight's factors
  HeldPiece<T> pieces[kAxes];  ///< of axes with a schedule
  T gain;                      ///< of every command
  T pn_error_factor, pn_rate_factor;
  int stage[kWidth<T>];
  T limit_rad;
  const EffectivenessRows* effectiveness[kWidth<T>];
  T effectiveness_end_s;
  T buckets_per_s;  ///< of rows that are buckets, else 1: their range is in time
  mutable RowMemory<T, EffectivenessRows::kRowSize> effectiveness_rows;
};
template <class T>
DISPERSA_INLINE void SetLoop(GimbalLoop<T>& loop, int lane, const AutopilotModel& model, int stage,
                             double pn_error_factor, double pn_rate_factor, double gain) {
  for (int axis = 0; axis < kAxes; ++axis)
    SetLane(loop.axes[axis], lane,
            model.laws.data()[axis].stages.data()[stage].WithPnFactors(pn_error_factor, pn_rate_factor));
  for (HeldPiece<T>& piece : loop.pieces) piece.range.Forget(lane);
  Lane(loop.gain, lane) = gain;
  Lane(loop.pn_error_factor, lane) = pn_error_factor;
  Lane(loop.pn_rate_factor, lane) = pn_rate_factor;
  loop.stage[lane] = stage;
  Lane(loop.limit_rad, lane) = model.stages.data()[stage].limit_rad;
  const EffectivenessRows* const table = model.effectiveness.data() + stage;
  loop.effectiveness[lane] = table;
  Lane(loop.effectiveness_end_s, lane) = table->end_s;
  Lane(loop.buckets_per_s, lane) = table->first.empty() ? table->buckets_per_s : 1.0;
  loop.effectiveness_rows.range.Forget(lane);
}

template <class T>
struct GimbalOutput {
  T deflection_rad[kAxes];  ///< commanded about roll, pitch, yaw
  AxisOutput<T> axes[kAxes];
};

/// Finds the pieces of a law that the lanes are in which `found` does not name.
template <class T>
DISPERSA_OUT_OF_LINE void FindPieces(const AxisLaw& law, const int* stage, T since_ignition_s,
                                     MaskOf<T> found, HeldPiece<T>& pieces) {
  const unsigned known = Bits(found);
  for (int lane = 0; lane < kWidth<T>; ++lane)
    if (!(known >> lane & 1u)) FindPiece(pieces, lane, law, stage[lane], Lane(since_ignition_s, lane));
}

/// Brings the laws that change within a stage to the lanes' times.
template <class T>
DISPERSA_OUT_OF_LINE void FollowSchedule(const AutopilotModel& model, T since_ignition_s,
                                         GimbalLoop<T>& loop) {
  for (int axis = 0; axis < kAxes; ++axis) {
    const AxisLaw& law = model.laws.data()[axis];
    if (law.config.schedule.empty()) continue;
    HeldPiece<T>& pieces = loop.pieces[axis];
    const auto found = pieces.range.Contains(since_ignition_s);
    if (!All(found)) FindPieces(law, loop.stage, since_ignition_s, found, pieces);
    StageLawOf<T>& now = loop.axes[axis];
    SetLaw(pieces, static_cast<int>(law.config.filters.size()), since_ignition_s, now);
    now.pn_error = now.pn_error * loop.pn_error_factor;
    now.pn_rate = now.pn_rate * loop.pn_rate_factor;
  }
}

/// Finds the rows of effectiveness of the lanes that `found` does not name.
template <class T>
DISPERSA_OUT_OF_LINE void FindEffectiveness(const GimbalLoop<T>& loop, T since_ignition_s, MaskOf<T> found) {
  const unsigned known = Bits(found);
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    if (known >> lane & 1u) continue;
    const EffectivenessRows& table = *loop.effectiveness[lane];
    const int row = table.IndexAt(Lane(since_ignition_s, lane));
    if (table.first.empty())
      loop.effectiveness_rows.range.Set(lane, row, row + 1);
    else
      loop.effectiveness_rows.range.Set(lane, row > 0 ? table.row_end_s.data()[row - 1] : 0.0,
                                        table.row_end_s.data()[row]);
    loop.effectiveness_rows.SetRow(lane, table.Row(row));
  }
}

/// Angular acceleration per radian of deflection now, about roll and about pitch and yaw, 1/s².
template <class T>
DISPERSA_INLINE void Effectiveness(const GimbalLoop<T>& loop, T since_ignition_s, T& of_roll, T& of_pitch) {
  const T since = Clamp(since_ignition_s, T(0.0), loop.effectiveness_end_s);
  const auto found = loop.effectiveness_rows.range.Contains(since * loop.buckets_per_s);
  if (!All(found)) FindEffectiveness(loop, since, found);
  const T* c = loop.effectiveness_rows.c;
  of_pitch = Fma(since, c[1], c[0]);
  of_roll = Fma(since, c[3], c[2]);
}

/// One tick of the acting lanes. Errors are reference less true, about x, y, z. `program_rad_s2`:
/// feed-forward of each axis, or null. `foreign_rad_s2`: a plug-in's command of each axis, or null. Of the
/// learnt values only pitch's are reported.
template <bool kAll, class T>
DISPERSA_INLINE void StepGimbals(const AutopilotModel& model, GimbalLoop<T>& loop, MaskOf<T> acting,
                                 T since_ignition_s, const Vector<T>& angle_rad, const Vector<T>& rate_rad_s,
                                 const T* program_rad_s2, const T* foreign_rad_s2, AxisMemory<T>* memory,
                                 GimbalOutput<T>& out) {
  if (model.is_scheduled) FollowSchedule(model, since_ignition_s, loop);
  T of_roll, of_pitch;
  Effectiveness(loop, since_ignition_s, of_roll, of_pitch);
  const T gain_over_both = loop.gain / (of_pitch * of_roll);
  const T per_pitch = gain_over_both * of_roll, per_roll = gain_over_both * of_pitch;

  const T angle[kAxes] = {angle_rad.x, angle_rad.y, angle_rad.z};
  const T rate[kAxes] = {rate_rad_s.x, rate_rad_s.y, rate_rad_s.z};
  for (int axis = 0; axis < kAxes; ++axis) {
    StepAxis<kAll>(model.laws.data()[axis].config, model.config.tick_s, loop.axes[axis], acting, angle[axis],
                   rate[axis], foreign_rad_s2 + (foreign_rad_s2 != nullptr ? axis : 0), axis == kPitch,
                   memory[axis], out.axes[axis]);
    if (program_rad_s2 != nullptr)
      out.axes[axis].command_rad_s2 = out.axes[axis].command_rad_s2 + program_rad_s2[axis];
    const T deflection = out.axes[axis].command_rad_s2 * (axis == kRoll ? per_roll : per_pitch);
    const T saturation =
        Select(deflection > loop.limit_rad, T(1.0), Select(deflection < -loop.limit_rad, T(-1.0), T(0.0)));
    memory[axis].saturation = Kept<kAll>(acting, saturation, memory[axis].saturation);
    out.deflection_rad[axis] = deflection;
  }
}

/// One cycle of the lanes that act: StepThrusters of reaction_control.h.
template <class T>
DISPERSA_INLINE void StepThrusters(const ReactionControlLogic& logic, int minimum_cycles, MaskOf<T> acting,
                                   T error_rad, T rate_rad_s, ThrusterStateOf<T>& memory) {
  const T s = Fma(T(logic.rate_gain_s), rate_rad_s, error_rad);
  const auto is_open = Abs(memory.direction) > T(0.5);
  const T cycles = memory.cycles_on + Select(is_open, T(1.0), T(0.0));
  const auto stays_open =
      is_open & ((cycles < T(static_cast<double>(minimum_cycles))) |
                 (s * memory.direction > T(logic.deadband_rad * (1.0 - logic.hysteresis))));
  const T anew =
      Select(s > T(logic.deadband_rad), T(1.0), Select(s < T(-logic.deadband_rad), T(-1.0), T(0.0)));
  memory.cycles_on = Select(acting, Select(stays_open, cycles, T(0.0)), memory.cycles_on);
  memory.direction = Select(acting, Select(stays_open, memory.direction, anew), memory.direction);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
