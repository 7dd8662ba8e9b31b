// Finds the plan whose predicted injection is the target's.
//
// Of all plans that arrive it is the one that departs least from the prior, by the sum of squares of the
// departures over their scales: Gauss-Newton on
//
//   sum ((x - x0) / scale)² + sum (miss / tolerance)²
//
// with tolerances so tight that the first sum chooses among what the second leaves open. With J' the Jacobian
// of miss / tolerance by x / scale and y = (x - x0) / scale, a step is
//
//   dx / scale = -y - J'ᵀ (J' J'ᵀ + 1)⁻¹ (miss / tolerance - J' y),
//
// four equations whatever the number of unknowns, solvable whatever the rank of J'. An unknown that a step
// would take beyond its bounds is held there, and the rest is solved for anew.
#pragma once

#include "core/guidance/predictor.h"

namespace dispersa {

struct CorrectorTask {
  std::array<bool, kPlanUnknowns> free{};
  Plan prior;  ///< what departures are counted from
  std::array<double, kPlanUnknowns> low{}, high{};
  bool meets_altitude = true;  ///< else only what a short rest of a burn can still change:
  bool meets_plane = true;     ///< speed and flight path angle
  int iterations = 3;
};

struct Correction {
  Plan plan;
  Arrival miss;  ///< of the plan, predicted less target
  double burnout_s = 0.0;
  bool arrives = false;  ///< within Arrives()
  int iterations = 0;
};

/// Misses that a plan may have and still arrive: 50 m, 0.5 m/s, 0.01 degree, and 0.02 degree of inclination.
/// Where altitude and plane are not met any more they do not count.
bool Arrives(const Arrival& miss, bool meets_altitude, bool meets_plane);

Correction Correct(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                   const NavigatedState& from, const Plan& start, const CorrectorTask& task);

}  // namespace dispersa
