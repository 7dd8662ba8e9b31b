// Thrust and flow of a burning engine, estimated from its sensed acceleration.
//
// At the commanded level f the acceleration is a = T P f / (M - F q X): P and q are the nominal full thrust
// and flow, X is the integral of f, M the mass without what has burnt. T and F are the factors sought. So
//
//   P f / (a M) = α - β q X / M,   α = 1 / T, β = F / T
//
// is linear in α and β. They are the least squares over the readings, of which older ones count less, and
// over the nominal values: thrust within 3 %, exhaust velocity (1 / β) within 1 %. So the estimate is usable
// from the first reading on. Masses that differ from nominal ones go into α and β: the acceleration is
// predicted correctly, and the time of depletion is not.
#pragma once

#include "core/guidance/mission.h"

namespace dispersa {

class EngineEstimate {
 public:
  explicit EngineEstimate(const GuidedStage& nominal) : nominal_(nominal) {}

  /// For a burn that begins with these: after another burn of the same engine.
  void Begin(double ignition_mass_kg, double usable_kg);
  /// GuidedStage's.
  void SeeLeft(unsigned bodies, double time_s) { nominal_.SeeLeft(bodies, time_s); }
  /// A reading of the accelerometer. `time_s` since lift-off, `expelled_kg` by the reaction control.
  void Add(double time_s, double since_ignition_s, double specific_force_m_s2, double expelled_kg);
  /// The stage as it burns. Thrust and flow stay within 15 % of nominal.
  GuidedStage Stage(double expelled_kg) const;

 private:
  GuidedStage nominal_;
  double sum_ = 0.0, sum_x_ = 0.0, sum_xx_ = 0.0, sum_y_ = 0.0, sum_xy_ = 0.0;
};

}  // namespace dispersa
