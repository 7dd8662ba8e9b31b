// The result of `dispersa optimize` as one self-contained page. It shows injection, flight program,
// trajectory, constraints and the course of the search.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trajectory/check_flight.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// `check`: the closed-loop nominal flight of the reference, if it was flown.
std::string TrajectoryPage(const OptimizationResult& result, const std::optional<CheckFlight>& check);

/// One condition of the target, in the unit of its name.
struct InjectionRow {
  std::string name;
  int decimals = 0;  ///< number of meaningful decimals
  double desired = 0.0, reached = 0.0, error = 0.0;
  double halved = 0.0;          ///< the error with half the steps
  std::optional<double> flown;  ///< the error of the closed-loop flight, if it is measured
};
/// The conditions that the target names, and no others.
std::vector<InjectionRow> InjectionRows(const OptimizationResult& result,
                                        const std::optional<CheckFlight>& check);

/// Greenwich's right ascension (rad, 0 to 2 pi) at the lift-off for which the orbit's node is the target's.
/// None if the target has no node.
std::optional<double> LiftOffSidereal(const Reference& reference);
/// Inclination and node of the orbit reached, and the lift-off time for the target's node.
std::string OrbitSentence(const Reference& reference);

/// A sentence that names each enforced limit that is at least ten times the reached value and so does not
/// bind. Empty if there is none.
std::string LimitsThatDoNotBind(const Reference& reference);

}  // namespace dispersa
