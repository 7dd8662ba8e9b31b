#include "core/vehicle/fins.h"

#include <algorithm>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kSubsonicMach = 0.9;
constexpr double kHalfChordMach = 2.0;
// The slope holds above it, as a body's (aerodynamics_build_up.cc).
constexpr double kFinHypersonicMach = 8.0;
constexpr double kWaveMach = 1.2;  ///< wave drag rises straight to here from kSubsonicMach

double AspectRatio(const FinSet& fins) { return 2.0 * Square(fins.span_m) / FinArea(fins); }

double Subsonic(const FinSet& fins, double mach) {
  const double aspect = AspectRatio(fins);
  const double run_m = fins.sweep_m + 0.5 * (fins.tip_chord_m - fins.root_chord_m);
  const double inverse_cosine = Sqrt(1.0 + Square(run_m / fins.span_m));
  const double beta = Sqrt(1.0 - Square(mach));
  return kTwoPi * aspect * FinArea(fins) / (2.0 + Sqrt(4.0 + Square(beta * aspect * inverse_cosine)));
}

double Supersonic(const FinSet& fins, double mach) {
  const double beta = Sqrt(Square(mach) - 1.0);
  return 4.0 / beta * FinArea(fins) * (1.0 - 0.5 / (beta * AspectRatio(fins)));
}

double Straight(double low, double at_low, double high, double at_high, double x) {
  const double share = Clamp((x - low) / (high - low), 0.0, 1.0);
  return at_low + share * (at_high - at_low);
}

}  // namespace

double FinArea(const FinSet& fins) { return 0.5 * (fins.root_chord_m + fins.tip_chord_m) * fins.span_m; }

double FinLiftArea(const FinSet& fins, double mach) {
  if (mach <= kSubsonicMach) return Subsonic(fins, mach);
  // Where the tips' Mach cones meet at the trailing edge, but well above the speed of sound.
  const double from = std::max(1.2, Sqrt(1.0 + 1.0 / Square(AspectRatio(fins))));
  const double m = std::min(mach, kFinHypersonicMach);
  if (m >= from) return Supersonic(fins, m);
  return Straight(kSubsonicMach, Subsonic(fins, kSubsonicMach), from, Supersonic(fins, from), m);
}

FinForce ForceOfFins(const FinSet& fins, double radius_m, double mach) {
  const double root = fins.root_chord_m, tip = fins.tip_chord_m, both = root + tip;
  const double mean_m = 2.0 / 3.0 * (both - root * tip / both);
  const double edge_m = fins.leading_edge_station_m + fins.sweep_m / 3.0 * (root + 2.0 * tip) / both;
  const double part = Straight(kSubsonicMach, 0.25, kHalfChordMach, 0.5, mach);
  const double with_body = 1.0 + radius_m / (radius_m + fins.span_m);
  return {0.5 * fins.count * FinLiftArea(fins, mach) * Square(with_body), edge_m + part * mean_m};
}

FinStrips StripsOf(const FinSet& fins, double radius_m) {
  const double root = fins.root_chord_m, tip = fins.tip_chord_m, s = fins.span_m, r = radius_m;
  return {0.5 * r * s * (root + tip) + Square(s) * (root + 2.0 * tip) / 6.0,
          0.5 * Square(r) * s * (root + tip) + r * Square(s) * (root + 2.0 * tip) / 3.0 +
              s * Square(s) * (root + 3.0 * tip) / 12.0};
}

double FinRollDamping(const FinSet& fins, double radius_m, double mach) {
  return fins.count * FinLiftArea(fins, mach) / FinArea(fins) * StripsOf(fins, radius_m).second_m4;
}

double FinWaveDragArea(const FinSet& fins, double mach) {
  if (mach <= kSubsonicMach) return 0.0;
  const double ratio = fins.thickness_m / (0.5 * (fins.root_chord_m + fins.tip_chord_m));
  const double at = std::max(mach, kWaveMach);
  const double wave = fins.count * FinArea(fins) * 4.0 * Square(ratio) / Sqrt(Square(at) - 1.0);
  return Straight(kSubsonicMach, 0.0, kWaveMach, wave, mach);
}

}  // namespace dispersa
