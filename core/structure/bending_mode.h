// A bent shape of a beam, and one of its bending modes.
#pragma once

#include <vector>

namespace dispersa {

struct BentShape {
  std::vector<double> deflection;  ///< at the nodes
  std::vector<double> slope_1_m;
  std::vector<double> bow;  ///< of the element behind each node (beam_elements.h)
};

struct BendingMode : BentShape {
  double frequency_rad_s = 0.0;
  double generalized_mass_kg = 0.0;
  /// Modal assurance criterion with the same mode at the level before, which has more propellant. Of drawn
  /// masses: with the same mode of the nominal masses.
  double mac = 1.0;
};

}  // namespace dispersa
