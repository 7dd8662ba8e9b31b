#include "core/guidance/corrector.h"

#include <cmath>

#include "core/guidance/bounded_step.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// Energy, path, path, plane, m/s. A degree of plane, 130 m/s, then asks for less than 0.1 degree of a thrust
// that lacks 10 m/s of energy. Then node and place.
constexpr double kTolerance[] = {1e-2, 3e-2, 3e-2, 1.0, 1.0, 10.0};
// Of a way that falls into the air, m: 1 km weighs as 33 m/s of energy. Where energy is missing, a low way
// leaves several m/s more for each kilometre.
constexpr double kDiveTolerance_m = 0.3;
// By how much a way may fall into it and still arrive.
constexpr double kArrivesDive_m = 1e3;
// Differences for derivatives: small against the curvature, large against the rounding of a prediction.
constexpr double kDifference = 3e-4;  // of a scale
// A step that moves no miss by more, in tolerances, needs no further one. Nor does a short one, in scales,
// that leaves so little: the next plan is made from it.
constexpr double kStill = 0.005;
constexpr double kShortStep = 0.01, kFoundMiss = 0.02;
// A turn of the perigee that costs a step 1.
constexpr double kTurn_rad = 0.3;
// Beyond this a step's straight lines say little.
constexpr double kLongestStep = 0.5;  // scales
// The share of the predicted decrease that a step must bring, and what follows one that does not: damping,
// first of what the misses leave open, where 1 halves a step, in the end of all.
constexpr double kEnoughDecrease = 1e-3;
constexpr double kFirstDamping = 1.0, kMoreDamping = 30.0;
constexpr int kTrials = 8, kBends = 3;

Arrival Less(const Arrival& a, const Arrival& b) {
  return {a.altitude_m - b.altitude_m, a.velocity_m_s - b.velocity_m_s,
          a.flight_path_angle_rad - b.flight_path_angle_rad, a.inclination_rad - b.inclination_rad};
}

// How misses are taken.
struct MissForm {
  bool turns = true;     ///< the perigee may turn in the plane, where the target lets it
  bool has_air = false;  ///< a fall into the air is a miss
};

// In tolerances. If the perigee `turns`, a step should turn it little, for the misses are straight lines only
// then: in place of the second miss, the turn since the injection before, whose miss is `before` (null:
// none).
Misses Scaled(const GuidanceMission& mission, const Injection& reached, const OrbitMiss* before,
              const CorrectorTask& task, const MissForm& form) {
  const OrbitMiss miss = OrbitMissOf(mission, reached);
  Misses m;
  m(0) = miss.energy_m_s / kTolerance[0];
  if (form.turns && task.meets_altitude && miss.size_m_s) {
    m(1) = before != nullptr
               ? (miss.across * before->along - miss.along * before->across) /
                     (Sqrt(Square(before->along) + Square(before->across)) * mission.orbit->eccentricity) /
                     kTurn_rad
               : 0.0;
    m(2) = *miss.size_m_s / kTolerance[2];
  } else {
    m(1) = miss.radial_m_s / kTolerance[1];
    m(2) = task.meets_altitude ? miss.shape_m_s / kTolerance[2] : 0.0;
  }
  m(3) = task.meets_plane ? miss.plane_m_s / kTolerance[3] : 0.0;
  m(4) = task.meets_plane ? miss.node_m_s / kTolerance[4] : 0.0;
  m(5) = task.meets_altitude ? miss.place_m_s / kTolerance[5] : 0.0;
  m(6) = form.has_air ? reached.dive_m / kDiveTolerance_m : 0.0;
  return m;
}

// Thrust at an angle to the velocity loses 1 - cos of its energy: the second derivative that a miss of energy
// has in the angles, in units of scales. Only what would be missing of the energy if no more were wasted, or
// if the engine burnt on, holds a step back, and what energy costs the reserve. `spent`: departures of waste
// and cut-off that could be had back.
Unknowns CurvatureOf(const GuidanceMission& mission, const Knowledge& known, const PlanPrior& prior,
                     const StepModel& model, double spent, double unburnt) {
  Unknowns curvature = Unknowns::Zero();
  double missing =
      -(model.miss(0) - spent * model.jacobian(0, kWaste)) - unburnt * model.jacobian(0, kCutOff);
  // What energy costs the reserve, as a miss of energy with the same slope.
  if (model.departure(kCutOff) > 0.0 && model.dearer(kCutOff) > 0.0 && model.jacobian(0, kCutOff) > 0.0)
    missing = std::fmax(
        missing, (1.0 + model.dearer(kCutOff)) * model.departure(kCutOff) / model.jacobian(0, kCutOff));
  if (!(missing > 0.0)) return curvature;
  const double last = missing * IdealVelocity(mission.last) / kTolerance[0];
  curvature(kPitchMiddle) = curvature(kYawMiddle) = last;
  curvature(kPitchHalf) = curvature(kYawHalf) = last / 3.0;
  if (known.phase == GuidancePhase::kBelowBurns || known.phase == GuidancePhase::kEarlierBurns)
    curvature(kBelowPitch) = curvature(kBelowYaw) = missing * IdealVelocity(mission.below) / kTolerance[0];
  if (known.phase == GuidancePhase::kEarlierBurns)
    curvature(kEarlierPitch) = curvature(kEarlierYaw) = missing * IdealVelocity(known.below) / kTolerance[0];
  for (int i = 0; i < kPlanUnknowns; ++i) curvature(i) *= Square(prior.scale[static_cast<std::size_t>(i)]);
  return curvature;
}

constexpr double kArrives_rad = 0.01 * kRadPerDeg;

// The same of an orbit that is not a state.
bool ArrivesInOrbit(const OrbitMiss& miss, double speed_m_s, bool meets_shape, bool meets_plane) {
  const double angle_m_s = kArrives_rad * speed_m_s;
  return std::fabs(miss.energy_m_s) <= 0.5 && std::fabs(miss.radial_m_s) <= angle_m_s &&
         (!meets_shape || std::fabs(miss.shape_m_s) <= angle_m_s) &&
         (!meets_plane || std::fabs(miss.plane_m_s) <= 2.0 * angle_m_s);
}
bool ArrivesInPlace(const OrbitMiss& miss, double speed_m_s, bool meets_shape, bool meets_plane) {
  const double angle_m_s = kArrives_rad * speed_m_s;
  return (!meets_shape || std::fabs(miss.place_m_s) <= 10.0 * angle_m_s) &&
         (!meets_plane || std::fabs(miss.node_m_s) <= 2.0 * angle_m_s);
}

}  // namespace

bool Arrives(const Arrival& miss, bool meets_altitude, bool meets_plane) {
  return (!meets_altitude || std::fabs(miss.altitude_m) <= 50.0) && std::fabs(miss.velocity_m_s) <= 0.5 &&
         std::fabs(miss.flight_path_angle_rad) <= 0.01 * kRadPerDeg &&
         (!meets_plane || std::fabs(miss.inclination_rad) <= kArrivesPlane_rad);
}

namespace {

// A step to a bound ends at the bound, without rounding.
double AfterStep(double value, double step, double scale, double low, double high) {
  if (step == (low - value) / scale) return low;
  if (step == (high - value) / scale) return high;
  return Clamp(value + step * scale, low, high);
}

Correction CorrectFirst(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                        const NavigatedState& from, const Plan& start, const CorrectorTask& task,
                        const MissForm& form) {
  Correction best;
  best.plan = start;
  // The way of the last plan that was predicted; derivatives by values of the last burn share the best one's.
  WayToLastBurn way;
  bool has_way = false;
  const auto predict = [&](const Plan& plan, bool keeps_way) {
    ++best.predictions;
    const Injection reached =
        Predict(mission, prior, known, from, plan, {}, has_way ? &way : nullptr, keeps_way ? &way : nullptr);
    has_way = has_way || keeps_way;
    return reached;
  };
  const auto keep = [&](const Plan& plan, const Injection& reached, const Misses& miss) {
    best.plan = plan;
    best.miss = Less(reached.at, mission.target);
    best.reached = reached;
    best.prioritised_miss = miss.norm();
  };
  const Injection at_start = predict(start, true);
  StepModel model;
  model.free = task.free;
  model.miss = Scaled(mission, at_start, nullptr, task, form);
  keep(start, at_start, model.miss);
  best.start_prioritised_miss = best.prioritised_miss;
  double damping = 0.0;
  const bool is_kept = task.keeps_solved && best.prioritised_miss <= kSolvedMiss;
  for (int iteration = 0; iteration < task.iterations && !is_kept; ++iteration) {
    const OrbitMiss before_step = OrbitMissOf(mission, best.reached);
    for (int i = 0; i < kPlanUnknowns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!task.free[k]) continue;
      const double scale = prior.scale[k], value = best.plan.value[k];
      model.departure(i) = (value - task.prior.value[k]) / scale;
      model.dearer(i) = prior.dearer[k];
      model.low(i) = Clamp((task.low[k] - value) / scale, -kLongestStep, 0.0);
      model.high(i) = Clamp((task.high[k] - value) / scale, 0.0, kLongestStep);
      Plan moved = best.plan;
      const double difference = model.high(i) > kDifference ? kDifference : -kDifference;
      moved.value[k] += difference * scale;
      model.jacobian.col(i) =
          (Scaled(mission, predict(moved, false), &before_step, task, form) - model.miss) / difference;
    }
    const Unknowns curvature = CurvatureOf(
        mission, known, prior, model,
        task.free[kWaste] ? (best.plan.value[kWaste] - task.low[kWaste]) / prior.scale[kWaste] : 0.0,
        task.free[kCutOff] ? (task.high[kCutOff] - best.plan.value[kCutOff]) / prior.scale[kCutOff] : 0.0);
    const double sum = model.At(Unknowns::Zero());
    const double highest = std::fmax(best.prioritised_miss, kSolvedMiss);
    best.iterations = iteration + 1;
    bool taken = false, is_still = false, is_found = false;
    for (int trial = 0; trial < kTrials && !taken && !is_still; ++trial) {
      const Unknowns weight = Unknowns::Constant(1.0 + damping) + curvature;
      const bool is_damped = damping > 0.0;
      // Misses are curved: the same Jacobian corrects the rest that a step leaves, before the step is
      // dropped.
      StepModel bent = model;
      double before = 1e300;
      for (int turn = 0; turn < kBends && !taken && !is_still; ++turn) {
        const Unknowns step = BoundedStep(bent, weight);
        Plan next = best.plan;
        for (int i = 0; i < kPlanUnknowns; ++i) {
          const auto k = static_cast<std::size_t>(i);
          if (task.free[k])
            next.value[k] = AfterStep(next.value[k], step(i), prior.scale[k], task.low[k], task.high[k]);
        }
        const Injection reached = predict(next, true);
        const Misses miss = Scaled(mission, reached, nullptr, task, form);
        const double next_sum = miss.squaredNorm() + model.CostOf(model.departure + step);
        is_still = (miss - model.miss).lpNorm<Eigen::Infinity>() < kStill &&
                   step.lpNorm<Eigen::Infinity>() < kDifference;
        // A prediction that is no number is no decrease.
        taken = miss.norm() <= highest &&
                (sum - next_sum >= kEnoughDecrease * std::fmax(sum - model.At(step), 0.0) ||
                 miss.norm() <= kSolvedMiss);
        if (taken) {
          keep(next, reached, miss);
          model.miss = miss;
          is_found =
              !is_damped &&
              (is_still || (miss.norm() <= kFoundMiss && step.lpNorm<Eigen::Infinity>() <= kShortStep));
        }
        if (!(miss.norm() < before)) break;
        before = miss.norm();
        bent.miss = miss - model.ChangeBy(step);
      }
      if (taken)
        damping = damping > kFirstDamping ? damping / kMoreDamping : 0.0;
      else
        damping = std::fmax(kMoreDamping * damping, kFirstDamping);
    }
    if (!taken || is_found) break;
  }
  const double speed_m_s = mission.target.velocity_m_s;
  const bool is_in_place =
      best.reached.dive_m <= kArrivesDive_m &&
      ArrivesInPlace(OrbitMissOf(mission, best.reached), speed_m_s, task.meets_altitude, task.meets_plane);
  if (mission.orbit) {
    best.arrives = is_in_place && ArrivesInOrbit(OrbitMissOf(mission, best.reached), speed_m_s,
                                                 task.meets_altitude, task.meets_plane);
    return best;
  }
  // An altitude that is not met any more is made up for by the speed.
  Arrival judged = best.miss;
  if (!task.meets_altitude) judged.velocity_m_s = model.miss(0) * kTolerance[0];
  best.arrives = is_in_place && Arrives(judged, task.meets_altitude, task.meets_plane);
  return best;
}

}  // namespace

Correction Correct(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                   const NavigatedState& from, const Plan& start, const CorrectorTask& task) {
  const auto with = [&](bool has_air) {
    Correction found = CorrectFirst(mission, prior, known, from, start, task, {true, has_air});
    if (found.arrives || !task.meets_altitude || !OrbitMissOf(mission, found.reached).size_m_s) return found;
    // Each way arrives from where the other one does not.
    const int predictions = found.predictions;
    if (const Correction held = CorrectFirst(mission, prior, known, from, start, task, {false, has_air});
        held.prioritised_miss < found.prioritised_miss)
      found = held;
    found.predictions += predictions;
    return found;
  };
  Correction found = with(false);
  if (!(found.reached.dive_m > 0.0)) return found;
  // Through the air, of which predictions know nothing: sought again, with that as a miss.
  const int predictions = found.predictions;
  found = with(true);
  found.predictions += predictions;
  return found;
}

}  // namespace dispersa
