#include "core/vehicle/cut_off.h"

#include <limits>

#include "core/math/assertion.h"
#include "core/math/functions.h"

namespace dispersa {

double CutOffSpeed(const Motor& motor, double radius_m, double altitude_m) {
  DISPERSA_ASSERT(EndsAtSpeed(motor));
  if (motor.cut_off == CutOff::kAtVelocity) return motor.cut_off_velocity_m_s;
  const AimedEnergy& aim = motor.aimed_energy;
  if (!aim.is_known) return std::numeric_limits<double>::infinity();
  const double squared =
      aim.is_ellipse
          ? 2.0 * (aim.energy_m2_s2 + aim.mu_m3_s2 / radius_m)
          : Square(aim.velocity_m_s) +
                2.0 * aim.mu_m3_s2 * (1.0 / radius_m - 1.0 / (radius_m - altitude_m + aim.altitude_m));
  return squared > 0.0 ? Sqrt(squared) : 0.0;
}

double CutOffSpeedRate(const Motor& motor, double radius_m, double altitude_m, double climb_m_s) {
  if (motor.cut_off == CutOff::kAtVelocity || !motor.aimed_energy.is_known) return 0.0;
  const double speed_m_s = CutOffSpeed(motor, radius_m, altitude_m);
  return speed_m_s > 0.0 ? -motor.aimed_energy.mu_m3_s2 * climb_m_s / (Square(radius_m) * speed_m_s) : 0.0;
}

}  // namespace dispersa
