#include "core/guidance/bounded_step.h"

#include <Eigen/Cholesky>

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

Misses StepModel::ChangeBy(const Unknowns& step) const {
  Misses change = Misses::Zero();
  for (int i = 0; i < kPlanUnknowns; ++i) change += jacobian.col(i) * step(i);
  return change;
}

namespace {

using Which = std::array<bool, kPlanUnknowns>;
std::size_t Index(int i) { return static_cast<std::size_t>(i); }

// The least value over those unknowns that move. The others stay where `step` has them.
Unknowns LeastOver(const StepModel& model, const Unknowns& weight, const Which& moves, const Unknowns& step) {
  Misses rest = model.miss;
  Eigen::Matrix<double, kMisses, kMisses> normal = Eigen::Matrix<double, kMisses, kMisses>::Identity();
  for (int i = 0; i < kPlanUnknowns; ++i) {
    const Misses slopes = model.jacobian.col(i);
    if (!moves[Index(i)]) {
      rest += slopes * step(i);
      continue;
    }
    const Misses weighted = slopes / weight(i);
    rest -= weighted * model.departure(i);
    normal += weighted * slopes.transpose();
  }
  const Misses pull = normal.llt().solve(rest);
  Unknowns least = step;
  for (int i = 0; i < kPlanUnknowns; ++i)
    if (moves[Index(i)]) least(i) = -(model.departure(i) + model.jacobian.col(i).dot(pull)) / weight(i);
  return least;
}

// The held unknown that would best leave its bound; -1 where none would.
int BestToRelease(const StepModel& model, const Unknowns& weight, const Which& moves, const Unknowns& step) {
  const Misses after = model.miss + model.ChangeBy(step);
  double largest = 0.0;
  for (int i = 0; i < kPlanUnknowns; ++i)
    largest = std::fmax(largest, std::fabs(model.jacobian.col(i).dot(model.miss)));
  // Less than this is rounding.
  double steepest = 1e-6 * (1.0 + largest);
  int best = -1;
  for (int i = 0; i < kPlanUnknowns; ++i) {
    if (!model.free[Index(i)] || moves[Index(i)]) continue;
    const double slope = model.jacobian.col(i).dot(after) + model.departure(i) + weight(i) * step(i);
    const double inwards = step(i) >= model.high(i) ? slope : -slope;
    if (inwards > steepest) {
      steepest = inwards;
      best = i;
    }
  }
  return best;
}

// The step where no departure is dear on one side only.
Unknowns EvenStep(const StepModel& model, const Unknowns& weight) {
  // More changes than unknowns are rare; rounding must not make it go round for ever.
  constexpr int kMostChanges = 4 * kPlanUnknowns;
  Which moves = model.free;
  Unknowns step = Unknowns::Zero();
  for (int change = 0; change < kMostChanges; ++change) {
    const Unknowns least = LeastOver(model, weight, moves, step);
    // Towards it until the first bound.
    int first = -1;
    double part = 1.0;
    for (int i = 0; i < kPlanUnknowns; ++i) {
      if (!moves[Index(i)]) continue;
      const double way = least(i) - step(i), room = (way > 0.0 ? model.high(i) : model.low(i)) - step(i);
      if (std::fabs(way) > std::fabs(room) && room / way < part) {
        part = room / way;
        first = i;
      }
    }
    for (int i = 0; i < kPlanUnknowns; ++i)
      if (moves[Index(i)])
        step(i) = Clamp(step(i) + part * (least(i) - step(i)), model.low(i), model.high(i));
    if (first >= 0) {
      step(first) = least(first) > step(first) ? model.high(first) : model.low(first);
      moves[Index(first)] = false;
      continue;
    }
    const int released = BestToRelease(model, weight, moves, step);
    if (released < 0) break;
    moves[Index(released)] = true;
  }
  return step;
}

}  // namespace

Unknowns BoundedStep(const StepModel& model, const Unknowns& weight) {
  // Two departures can be dear.
  constexpr int kSides = 4;
  Unknowns step = Unknowns::Zero();
  for (int trial = 0; trial < kSides; ++trial) {
    StepModel even = model;
    Unknowns even_weight = weight;
    const Unknowns side = model.departure + step;
    for (int i = 0; i < kPlanUnknowns; ++i) {
      if (!(side(i) > 0.0)) continue;
      even.departure(i) += model.dearer(i) * model.departure(i);
      even_weight(i) += model.dearer(i);
    }
    step = EvenStep(even, even_weight);
    bool stays = true;
    for (int i = 0; i < kPlanUnknowns; ++i)
      stays = stays && (model.dearer(i) == 0.0 || (model.departure(i) + step(i) > 0.0) == (side(i) > 0.0));
    if (stays) break;
  }
  return step;
}

}  // namespace dispersa
