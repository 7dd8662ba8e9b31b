// What `dispersa optimize` found, as one self-contained page: the injection, the flight program and its
// trajectory, the constraints, and how the search went.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trajectory/optimize.h"

namespace dispersa {

/// `flown`: the injection errors of the closed-loop nominal flight of the reference, if it was flown.
std::string TrajectoryPage(const OptimizationResult& result, const std::optional<OrbitErrors>& flown);

/// One condition of the target, in the unit of its name.
struct InjectionRow {
  std::string name;
  int decimals = 0;  ///< that mean something
  double desired = 0.0, reached = 0.0, error = 0.0;
  double halved = 0.0;          ///< the error with half the steps
  std::optional<double> flown;  ///< the error of the closed-loop flight, where it is measured
};
/// What the target names, and nothing else.
std::vector<InjectionRow> InjectionRows(const OptimizationResult& result,
                                        const std::optional<OrbitErrors>& flown);

/// Greenwich's right ascension (rad, 0 to 2 pi) at a lift-off that brings the orbit's node to the target's;
/// none of a target without node.
std::optional<double> LiftOffSidereal(const Reference& reference);
/// Inclination and node of the orbit reached, and when to lift off for the target's node.
std::string OrbitSentence(const Reference& reference);

/// Says of each enforced limit that is ten times the value or more that it does not bind; empty if none.
std::string LimitsThatDoNotBind(const Reference& reference);

}  // namespace dispersa
