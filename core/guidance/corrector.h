// Finds the guidance plan whose predicted injection is the target's or, where no plan arrives, the best
// orbit.
//
// Of all plans that arrive it is the one nearest to the prior, by the sum of squares of the departures over
// their scales. It takes Levenberg-Marquardt steps on
//
//   sum ((x - x0) / scale)² + sum (miss / tolerance)²
//
// A way that falls into the air is sought again with the fall as one more miss, because predictions have no
// air.
//
// The tolerances are so tight that the first sum only chooses among plans that meet the second. The misses
// are those of orbit_miss.h. Path has three times the tolerance of energy, the plane a hundred times, the
// place a thousand times. So energy comes first, then path, then plane, then place.
//
// J' is the Jacobian of miss / tolerance by x / scale, and y = (x - x0) / scale. A step is
//
//   dx / scale = -W⁻¹ y - W⁻¹ J'ᵀ (J' W⁻¹ J'ᵀ + 1)⁻¹ (miss / tolerance - J' W⁻¹ y)
//
// within the bounds (bounded_step.h). These are as many equations as misses for any number of unknowns,
// solvable for any rank of J'. W is 1, and more in two cases:
// - Energy is missing that no smaller turn gives back. Energy is greatest along the velocity, where J' says
//   nothing of the angles. Without W a step could have any length.
// - A step did not make the sum smaller. Such a step is not taken.
#pragma once

#include "core/guidance/orbit_miss.h"

namespace dispersa {

struct CorrectorTask {
  std::array<bool, kPlanUnknowns> free{};
  Plan prior;  ///< origin of the departures
  std::array<double, kPlanUnknowns> low{}, high{};
  bool meets_altitude = true;  ///< if false, a short rest of a burn can only change
  bool meets_plane = true;     ///< speed and flight path angle
  int iterations = 3;
  bool keeps_solved = false;  ///< a start whose prioritised miss is at most kSolvedMiss stays as it is
};

struct Correction {
  Plan plan;
  Arrival miss;  ///< of the plan, predicted less target
  /// Square root of the misses' sum, of the plan. Never more than the start's, or than kSolvedMiss.
  double prioritised_miss = 0.0, start_prioritised_miss = 0.0;
  Injection reached;     ///< of the plan
  bool arrives = false;  ///< within Arrives()
  int iterations = 0;
  int predictions = 0;
};

/// A prioritised miss that is none: a millimetre a second of energy and path, a tenth of a metre a second of
/// plane.
inline constexpr double kSolvedMiss = 0.1;

/// Of the plane, for a plan and for a flight that still arrive.
inline constexpr double kArrivesPlane_rad = 0.02 * kRadPerDeg;
/// Misses with which a plan still arrives: 50 m, 0.5 m/s, 0.01 degree, and kArrivesPlane_rad of inclination.
/// Altitude and plane do not count once they cannot be met any more.
bool Arrives(const Arrival& miss, bool meets_altitude, bool meets_plane);

Correction Correct(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                   const NavigatedState& from, const Plan& start, const CorrectorTask& task);

}  // namespace dispersa
