#include "core/guidance/motor_estimate.h"

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

namespace {

// Readings and time that a line takes to be trusted.
constexpr double kEnough = 4.0;
constexpr double kLongEnough_s = 3.0;
// After the nominal ends of the ramps, which differ from motor to motor.
constexpr double kClear_s = 0.2;
constexpr double kFarthest = 0.15;

// A stage that becomes lighter at once has neither. One with either loses bodies with a criterion alone.
bool HasLine(const GuidedStage& stage) { return !stage.burn.curve && !stage.loses_mass; }
bool HasCurve(const GuidedStage& stage) { return stage.burn.curve && !stage.loses_mass; }

}  // namespace

double StandsAfter(const GuidedStage& nominal, double first_s, double period_s) {
  if (nominal.is_engine() || HasCurve(nominal)) return first_s + kLongEnough_s;  // by their own estimates
  if (!HasLine(nominal)) return 0.0;
  return std::fmax(first_s, nominal.burn.rise_s + kClear_s) +
         std::fmax(kLongEnough_s, (kEnough - 1.0) * period_s);
}

void MotorEstimate::SeeLeft(unsigned bodies, double time_s) {
  if (!nominal_.SeeLeft(bodies, time_s)) return;
  count_ = sum_t_ = sum_y_ = sum_tt_ = sum_ty_ = 0.0;
  by_curve_.BeginAnew();
}

void MotorEstimate::Add(double since_ignition_s, double specific_force_m_s2, double expelled_kg) {
  const MotorBurn& burn = nominal_.burn;
  if (HasCurve(nominal_)) by_curve_.Add(nominal_, since_ignition_s, specific_force_m_s2, expelled_kg);
  if (!HasLine(nominal_)) return;
  const double full_until_s = (1.0 - kFarthest) * burn.duration_s - burn.tail_s;
  if (since_ignition_s < burn.rise_s + kClear_s || since_ignition_s > full_until_s ||
      !(specific_force_m_s2 > 0.0))
    return;
  const double t = since_ignition_s - 0.5 * burn.rise_s, y = 1.0 / specific_force_m_s2;
  if (count_ == 0.0) first_s_ = t;
  last_s_ = t;
  count_ += 1.0;
  sum_t_ += t;
  sum_y_ += y;
  sum_tt_ += t * t;
  sum_ty_ += t * y;
}

GuidedStage MotorEstimate::Stage(double expelled_kg) const {
  GuidedStage stage = nominal_;
  stage.ignition_mass_kg -= expelled_kg;
  if (HasCurve(nominal_)) by_curve_.Apply(stage.burn);
  if (count_ < kEnough || last_s_ - first_s_ < kLongEnough_s) return stage;
  const double mean_t = sum_t_ / count_, mean_y = sum_y_ / count_;
  const double slope = (sum_ty_ / count_ - mean_t * mean_y) / (sum_tt_ / count_ - mean_t * mean_t);
  const double at_start = mean_y - slope * mean_t;
  if (!(slope < 0.0) || !(at_start > 0.0)) return stage;
  const double exhaust_m_s = -1.0 / slope;
  const double mass_kg = stage.LessDropped(stage.ignition_mass_kg);
  const double flow_kg_s = mass_kg / (exhaust_m_s * at_start);
  MotorBurn& burn = stage.burn;
  const double flow_factor = Clamp(flow_kg_s / burn.full_flow_kg_s, 1.0 - kFarthest, 1.0 + kFarthest);
  const double thrust_factor =
      Clamp(exhaust_m_s * flow_kg_s / burn.vacuum_thrust_n, 1.0 - kFarthest, 1.0 + kFarthest);
  burn.full_flow_kg_s *= flow_factor;
  burn.vacuum_thrust_n *= thrust_factor;
  burn.duration_s =
      (burn.propellant_mass_kg - burn.left_kg) / burn.full_flow_kg_s + 0.5 * (burn.rise_s + burn.tail_s);
  return stage;
}

}  // namespace dispersa
