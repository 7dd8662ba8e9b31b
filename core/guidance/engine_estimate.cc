#include "core/guidance/engine_estimate.h"

#include "core/math/functions.h"

namespace dispersa {

namespace {

// Standard deviations: of a reading, and of α and β before the first one.
constexpr double kReading = 1e-4, kThrust = 0.03, kExhaust = 0.01;
// What a reading counts after the next one.
constexpr double kKept = 0.9;
constexpr double kMostFactor = 0.15;

}  // namespace

void EngineEstimate::Begin(double ignition_mass_kg, double usable_kg) {
  nominal_.ignition_mass_kg = ignition_mass_kg;
  nominal_.usable_kg = usable_kg;
}

void EngineEstimate::Add(double time_s, double since_ignition_s, double specific_force_m_s2,
                         double expelled_kg) {
  const double level = nominal_.levels->At(since_ignition_s);
  const double mass_kg = nominal_.ignition_mass_kg - nominal_.DroppedBy(time_s) - expelled_kg;
  if (!(level > 0.0) || !(specific_force_m_s2 > 0.0) || !(mass_kg > 0.0)) return;
  const double x = nominal_.burn.full_flow_kg_s * nominal_.levels->Sum(since_ignition_s) / mass_kg;
  // Less the nominal motor's.
  const double y = nominal_.burn.vacuum_thrust_n * level / (specific_force_m_s2 * mass_kg) - (1.0 - x);
  sum_ = kKept * sum_ + 1.0;
  sum_x_ = kKept * sum_x_ + x;
  sum_xx_ = kKept * sum_xx_ + x * x;
  sum_y_ = kKept * sum_y_ + y;
  sum_xy_ = kKept * sum_xy_ + x * y;
}

GuidedStage EngineEstimate::Stage(double expelled_kg) const {
  GuidedStage stage = nominal_;
  stage.ignition_mass_kg -= expelled_kg;
  const double aa = sum_ + Square(kReading / kThrust), ab = -sum_x_,
               bb = sum_xx_ + Square(kReading / kExhaust);
  const double determinant = aa * bb - ab * ab;
  const double alpha = 1.0 + (sum_y_ * bb + sum_xy_ * ab) / determinant;
  const double beta = 1.0 - (aa * sum_xy_ + ab * sum_y_) / determinant;
  if (!(alpha > 0.0)) return stage;
  stage.burn.vacuum_thrust_n *= Clamp(1.0 / alpha, 1.0 - kMostFactor, 1.0 + kMostFactor);
  stage.burn.full_flow_kg_s *= Clamp(beta / alpha, 1.0 - kMostFactor, 1.0 + kMostFactor);
  return stage;
}

}  // namespace dispersa
