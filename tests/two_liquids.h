// What two tanks of an engine hold after some propellant has flown in another mixture than they were filled
// in, by hand.
#pragma once

#include <algorithm>

namespace dispersa {

struct TwoLiquids {
  double first_kg, second_kg;  ///< loads
  double rest_kg;              ///< of both together, that stays

  struct Left {
    double first_kg, second_kg;
  };
  Left After(double flown_kg, double load, double ratio) const {
    const double r = ratio * first_kg / second_kg;
    return {load * first_kg - flown_kg * r / (1.0 + r), load * second_kg - flown_kg / (1.0 + r)};
  }
  /// The rest counts of each by its load. The burn ends when the first of them has only that left.
  double Usable(double load, double ratio) const {
    const double part = 1.0 - rest_kg / (load * (first_kg + second_kg)), r = ratio * first_kg / second_kg;
    return part * load * std::min(first_kg * (1.0 + r) / r, second_kg * (1.0 + r));
  }
};

}  // namespace dispersa
