// Burn rate and exhaust velocity of a solid motor with a thrust curve, estimated from its sensed
// acceleration.
//
// With the factors k of the burn rate and c of the exhaust velocity, a(t) = c k P f(k t) / (m0 - b(k t)): P
// is the nominal full thrust, f the curve, b the propellant burnt, m0 the mass at ignition. Each reading is
// taken as linear in ln k and ln c about the estimate before it. Both are the least squares over the readings
// and over the nominal values: burn rate within 3 %, exhaust velocity within 1 %. So the estimate is usable
// from the first reading on. Readings where the curve is steep are left out: there the burn rate shows as an
// error of time.
#pragma once

#include "core/guidance/mission.h"

namespace dispersa {

class CurveEstimate {
 public:
  /// `expelled_kg`: what the stage's mass has lost to reaction control.
  void Add(const GuidedStage& nominal, double since_ignition_s, double specific_force_m_s2,
           double expelled_kg);
  /// The motor as it burns. Both factors stay within 15 % of 1.
  void Apply(MotorBurn& burn) const;
  /// Of another mass: the readings so far are of no use.
  void BeginAnew() { *this = {}; }

 private:
  struct Logs {
    double rate = 0.0, exhaust = 0.0;
  };
  Logs Found() const;

  double sum_ = 0.0, sum_x_ = 0.0, sum_xx_ = 0.0, sum_y_ = 0.0, sum_xy_ = 0.0;
};

}  // namespace dispersa
