#include "core/guidance/bounded_step.h"

#include <Eigen/Cholesky>

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

namespace {

using Which = std::array<bool, kPlanUnknowns>;
std::size_t Index(int i) { return static_cast<std::size_t>(i); }

// The least value over those unknowns that move, the others where `step` has them.
template <int count, int misses>
Unknowns<count> LeastOver(const StepModel<count, misses>& model, const Unknowns<count>& weight,
                          const Which& moves, const Unknowns<count>& step) {
  Eigen::Matrix<double, misses, count> j = model.jacobian;
  Unknowns<count> y = model.departure.cwiseQuotient(weight);
  Misses<misses> rest = model.miss;
  for (int i = 0; i < count; ++i) {
    if (moves[Index(i)]) continue;
    rest += model.jacobian.col(i) * step(i);
    j.col(i).setZero();
    y(i) = 0.0;
  }
  const Eigen::Matrix<double, misses, count> weighted = j * weight.cwiseInverse().asDiagonal();
  const Eigen::Matrix<double, misses, misses> normal =
      weighted * j.transpose() + Eigen::Matrix<double, misses, misses>::Identity();
  return -y - weighted.transpose() * normal.llt().solve(rest - j * y);
}

// The held unknown that would best leave its bound; -1 where none would.
template <int count, int misses>
int BestToRelease(const StepModel<count, misses>& model, const Unknowns<count>& weight, const Which& moves,
                  const Unknowns<count>& step) {
  const Unknowns<count> slope = model.jacobian.transpose() * (model.miss + model.jacobian * step) +
                                model.departure + weight.cwiseProduct(step);
  // Less than this is rounding.
  double steepest =
      1e-6 * (1.0 + (model.jacobian.transpose() * model.miss).template lpNorm<Eigen::Infinity>());
  int best = -1;
  for (int i = 0; i < count; ++i) {
    if (!model.free[Index(i)] || moves[Index(i)]) continue;
    const double inwards = step(i) >= model.high(i) ? slope(i) : -slope(i);
    if (inwards > steepest) {
      steepest = inwards;
      best = i;
    }
  }
  return best;
}

// The step where no departure is dear on one side only.
template <int count, int misses>
Unknowns<count> EvenStep(const StepModel<count, misses>& model, const Unknowns<count>& weight) {
  // More changes than unknowns are rare; rounding must not make it go round for ever.
  constexpr int kMostChanges = 4 * count;
  Which moves = model.free;
  Unknowns<count> step = Unknowns<count>::Zero();
  for (int change = 0; change < kMostChanges; ++change) {
    const Unknowns<count> least = LeastOver(model, weight, moves, step);
    // Towards it until the first bound.
    int first = -1;
    double part = 1.0;
    for (int i = 0; i < count; ++i) {
      if (!moves[Index(i)]) continue;
      const double way = least(i) - step(i), room = (way > 0.0 ? model.high(i) : model.low(i)) - step(i);
      if (std::fabs(way) > std::fabs(room) && room / way < part) {
        part = room / way;
        first = i;
      }
    }
    for (int i = 0; i < count; ++i)
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

template <int count, int misses>
Unknowns<count> BoundedStep(const StepModel<count, misses>& model, const Unknowns<count>& weight) {
  // Two departures can be dear.
  constexpr int kSides = 4;
  Unknowns<count> step = Unknowns<count>::Zero();
  for (int trial = 0; trial < kSides; ++trial) {
    StepModel<count, misses> even = model;
    Unknowns<count> even_weight = weight;
    const Unknowns<count> side = model.departure + step;
    for (int i = 0; i < count; ++i) {
      if (!(side(i) > 0.0)) continue;
      even.departure(i) += model.dearer(i) * model.departure(i);
      even_weight(i) += model.dearer(i);
    }
    step = EvenStep(even, even_weight);
    bool stays = true;
    for (int i = 0; i < count; ++i)
      stays = stays && (model.dearer(i) == 0.0 || (model.departure(i) + step(i) > 0.0) == (side(i) > 0.0));
    if (stays) break;
  }
  return step;
}

#define DISPERSA_BOUNDED_STEP(count, misses) \
  template Unknowns<count> BoundedStep<count, misses>(const StepModel<count, misses>&, const Unknowns<count>&)
DISPERSA_BOUNDED_STEP(kUncutUnknowns, kMisses);
DISPERSA_BOUNDED_STEP(kTwoBurnUnknowns, kMisses);
DISPERSA_BOUNDED_STEP(kPlanUnknowns, kMisses);
DISPERSA_BOUNDED_STEP(kUncutUnknowns, kAllMisses);
DISPERSA_BOUNDED_STEP(kTwoBurnUnknowns, kAllMisses);
DISPERSA_BOUNDED_STEP(kPlanUnknowns, kAllMisses);
DISPERSA_BOUNDED_STEP(kUncutUnknowns, kMissesAndAir);
DISPERSA_BOUNDED_STEP(kTwoBurnUnknowns, kMissesAndAir);
DISPERSA_BOUNDED_STEP(kPlanUnknowns, kMissesAndAir);
DISPERSA_BOUNDED_STEP(kUncutUnknowns, kAllMissesAndAir);
DISPERSA_BOUNDED_STEP(kTwoBurnUnknowns, kAllMissesAndAir);
DISPERSA_BOUNDED_STEP(kPlanUnknowns, kAllMissesAndAir);
#undef DISPERSA_BOUNDED_STEP

}  // namespace dispersa
