#include "core/control/filter.h"

#include "core/math/functions.h"

namespace dispersa {

DigitalSection Discretise(const FilterSection& f, double tick_s) {
  // s = k (z - 1) / (z + 1), in units of the poles' frequency.
  const SinCos half = SineCosine(0.5 * f.poles_rad_s * tick_s);
  const double k = half.cos / half.sin;
  const double ratio = f.zeros_rad_s > 0.0 ? f.poles_rad_s / f.zeros_rad_s : 0.0;
  // (c2 s² + c1 s + 1) (z + 1)², by falling powers of z.
  const auto expand = [k](double c2, double c1, double* by_power) {
    by_power[0] = c2 * k * k + c1 * k + 1.0;
    by_power[1] = 2.0 - 2.0 * c2 * k * k;
    by_power[2] = c2 * k * k - c1 * k + 1.0;
  };
  double above[3], below[3];
  expand(ratio * ratio, 2.0 * f.zeros_damping * ratio, above);
  expand(1.0, 2.0 * f.poles_damping, below);
  return {above[0] / below[0], above[1] / below[0], above[2] / below[0], below[1] / below[0],
          below[2] / below[0]};
}

}  // namespace dispersa
