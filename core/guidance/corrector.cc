#include "core/guidance/corrector.h"

#include <Eigen/Cholesky>

#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr int kMisses = 4;
using Misses = Eigen::Matrix<double, kMisses, 1>;
using Unknowns = Eigen::Matrix<double, kPlanUnknowns, 1>;
using Jacobian = Eigen::Matrix<double, kMisses, kPlanUnknowns>;

// Altitude, speed, flight path angle, inclination: a hundredth of what a mission would notice.
constexpr double kTolerance[kMisses] = {1.0, 1e-2, 1e-6, 1e-5};
// Differences for derivatives: small against the curvature, large against the rounding of a prediction.
constexpr double kDifference = 1e-3;  // of a scale
// A solution within a twentieth of the tolerances needs no further step.
constexpr double kSolved = 0.05;

Arrival Less(const Arrival& a, const Arrival& b) {
  return {a.altitude_m - b.altitude_m, a.velocity_m_s - b.velocity_m_s,
          a.flight_path_angle_rad - b.flight_path_angle_rad, a.inclination_rad - b.inclination_rad};
}

Misses Scaled(const Arrival& miss, const CorrectorTask& task) {
  Misses m;
  m << (task.meets_altitude ? miss.altitude_m / kTolerance[0] : 0.0), miss.velocity_m_s / kTolerance[1],
      miss.flight_path_angle_rad / kTolerance[2],
      (task.meets_plane ? miss.inclination_rad / kTolerance[3] : 0.0);
  return m;
}

// The step in units of scales, within the bounds.
Unknowns StepOf(const Jacobian& jacobian, const Misses& miss, const Unknowns& departure, const Unknowns& low,
                const Unknowns& high, std::array<bool, kPlanUnknowns> free) {
  Unknowns step = Unknowns::Zero();
  for (;;) {
    Jacobian j = jacobian;
    Unknowns y = departure;
    Misses rest = miss;
    for (int i = 0; i < kPlanUnknowns; ++i) {
      if (free[static_cast<std::size_t>(i)]) continue;
      rest += jacobian.col(i) * step(i);
      j.col(i).setZero();
      y(i) = 0.0;
    }
    const Eigen::Matrix<double, kMisses, kMisses> normal =
        j * j.transpose() + Eigen::Matrix<double, kMisses, kMisses>::Identity();
    const Misses multipliers = normal.llt().solve(rest - j * y);
    const Unknowns found = -y - j.transpose() * multipliers;
    int worst = -1;
    double beyond = 0.0;
    for (int i = 0; i < kPlanUnknowns; ++i) {
      if (!free[static_cast<std::size_t>(i)]) continue;
      step(i) = found(i);
      const double over = step(i) > high(i) ? step(i) - high(i) : low(i) > step(i) ? low(i) - step(i) : 0.0;
      if (over > beyond) {
        beyond = over;
        worst = i;
      }
    }
    if (worst < 0) return step;
    step(worst) = Clamp(step(worst), low(worst), high(worst));
    free[static_cast<std::size_t>(worst)] = false;
  }
}

}  // namespace

bool Arrives(const Arrival& miss, bool meets_altitude, bool meets_plane) {
  return (!meets_altitude || std::fabs(miss.altitude_m) <= 50.0) && std::fabs(miss.velocity_m_s) <= 0.5 &&
         std::fabs(miss.flight_path_angle_rad) <= 0.01 * kRadPerDeg &&
         (!meets_plane || std::fabs(miss.inclination_rad) <= 0.02 * kRadPerDeg);
}

Correction Correct(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                   const NavigatedState& from, const Plan& start, const CorrectorTask& task) {
  Correction best;
  best.plan = start;
  const auto predict = [&](const Plan& plan) { return Predict(mission, prior, known, from, plan); };
  Injection reached = predict(best.plan);
  best.miss = Less(reached.at, mission.target);
  best.burnout_s = reached.time_s;
  Misses miss = Scaled(best.miss, task);
  for (int iteration = 0; iteration < task.iterations; ++iteration) {
    Jacobian jacobian = Jacobian::Zero();
    Unknowns departure = Unknowns::Zero(), low = Unknowns::Zero(), high = Unknowns::Zero();
    for (int i = 0; i < kPlanUnknowns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!task.free[k]) continue;
      const double scale = prior.scale[k], value = best.plan.value[k];
      departure(i) = (value - task.prior.value[k]) / scale;
      low(i) = (task.low[k] - value) / scale;
      high(i) = (task.high[k] - value) / scale;
      Plan moved = best.plan;
      const double difference = high(i) > kDifference ? kDifference : -kDifference;
      moved.value[k] += difference * scale;
      jacobian.col(i) = (Scaled(Less(predict(moved).at, mission.target), task) - miss) / difference;
    }
    const Unknowns step = StepOf(jacobian, miss, departure, low, high, task.free);
    Plan next = best.plan;
    for (int i = 0; i < kPlanUnknowns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (task.free[k])
        next.value[k] = Clamp(next.value[k] + step(i) * prior.scale[k], task.low[k], task.high[k]);
    }
    reached = predict(next);
    const Arrival next_miss = Less(reached.at, mission.target);
    best.iterations = iteration + 1;
    // A prediction that is no number ends the search where it was.
    const Misses next_scaled = Scaled(next_miss, task);
    if (!(next_scaled.squaredNorm() < 1e300)) break;
    const bool is_still = (next_scaled - miss).lpNorm<Eigen::Infinity>() < kSolved;
    best.plan = next;
    best.miss = next_miss;
    best.burnout_s = reached.time_s;
    miss = next_scaled;
    if (is_still && step.lpNorm<Eigen::Infinity>() < 1e-3) break;
  }
  best.arrives = Arrives(best.miss, task.meets_altitude, task.meets_plane);
  return best;
}

}  // namespace dispersa
