#include "core/guidance/plan.h"

#include "core/math/functions.h"

namespace dispersa {

double Plan::TurnHalf() const { return Sqrt(6.0 * value[kWaste]); }

Direction Plan::LastBurnAt(double since_ignition_s, double nominal_duration_s, double yaw_half_rad) const {
  const double since = since_ignition_s > 0.0 ? since_ignition_s : 0.0;
  const double s = 2.0 * since / nominal_duration_s - 1.0;
  return {value[kPitchMiddle] + s * value[kPitchHalf], value[kYawMiddle] + s * (yaw_half_rad - TurnHalf())};
}

Direction Plan::LastBurnRate(double nominal_duration_s, double yaw_half_rad) const {
  const double slope = 2.0 / nominal_duration_s;
  return {slope * value[kPitchHalf], slope * (yaw_half_rad - TurnHalf())};
}

PlanPrior BuildPrior(const GuidanceMission& mission) {
  PlanPrior prior;
  const double burnout_s = mission.last_ignition_s + mission.last.burn.duration_s;
  const Direction from = mission.program.At(mission.last_ignition_s), to = mission.program.At(burnout_s);
  auto& value = prior.nominal.value;
  value[kIgnition] = mission.last_ignition_s;
  value[kPitchMiddle] = 0.5 * (from.pitch_rad + to.pitch_rad);
  value[kPitchHalf] = 0.5 * (to.pitch_rad - from.pitch_rad);
  value[kYawMiddle] = 0.5 * (from.yaw_rad + to.yaw_rad);
  value[kWaste] = mission.velocity_reserve_m_s / IdealVelocity(mission.last);
  prior.yaw_half_rad = 0.5 * (to.yaw_rad - from.yaw_rad);

  constexpr double kDeg = kRadPerDeg;
  prior.scale = {2.0 * kDeg, 1.0 * kDeg, 20.0, 5.0 * kDeg, 5.0 * kDeg, 3.0 * kDeg, 0.03};
  const std::array<double, kPlanUnknowns> reach = {10.0 * kDeg, 5.0 * kDeg,  120.0, 25.0 * kDeg,
                                                   25.0 * kDeg, 25.0 * kDeg, 0.0};
  for (int i = 0; i < kPlanUnknowns; ++i) {
    const auto k = static_cast<std::size_t>(i);
    prior.low[k] = value[k] - reach[k];
    prior.high[k] = value[k] + reach[k];
  }
  // From no turn, of which nothing is left to give, to one of 45 degrees either way.
  prior.low[kWaste] = 0.0;
  prior.high[kWaste] = Square(45.0 * kDeg) / 6.0;
  return prior;
}

}  // namespace dispersa
