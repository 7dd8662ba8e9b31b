#include "core/vehicle/shock_expansion.h"

#include <algorithm>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

constexpr double kGamma = 1.4;
constexpr int kElementsOfCurve = 24;      // 48 change C_Na by 0.1 % (ogive of fineness 3), 2 % (0.9)
constexpr int kPanels = 32;               // of Simpson's rule on an element
constexpr double kSlowestMach = 1.1;      // marching needs supersonic flow with some margin
constexpr double kRelaxationRate = 0.65;  // times 1 / (r sqrt(M^2 - 1)) along the axis

/// A piece of a cone. Lengths in m, angle against the axis.
struct Element {
  double start_m;
  double length_m;
  double start_radius_m;
  double slope;
  double angle_rad;
};

/// Flow along the surface.
struct Surface {
  double mach;
  double pressure;         ///< over free-stream pressure
  double loading_per_rad;  ///< its derivative over incidence, on the windward meridian
};

double StagnationRatio(double mach) { return Pow(1.0 + 0.2 * Square(mach), 3.5); }

double MachOfStagnationRatio(double ratio) {
  return Sqrt(std::max(0.0, 5.0 * (Pow(ratio, 1.0 / 3.5) - 1.0)));
}

/// Stagnation pressure behind over ahead of a shock by its normal Mach number.
double ShockLoss(double normal_mach) {
  const double m2 = Square(std::max(1.0, normal_mach));
  return Pow(2.4 * m2 / (0.4 * m2 + 2.0), 3.5) * Pow(2.4 / (2.8 * m2 - 0.4), 2.5);
}

double PrandtlMeyer(double mach) {
  const double root = Sqrt(std::max(0.0, Square(mach) - 1.0));
  return Sqrt(6.0) * Atan(root / Sqrt(6.0)) - Atan(root);
}

double MachOfPrandtlMeyer(double angle_rad) {
  double low = 1.0;
  double high = 100.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (PrandtlMeyer(middle) < angle_rad ? low : high) = middle;
  }
  return low;
}

double ConePressure(double mach, double angle_rad) {
  return 1.0 + 0.5 * kGamma * Square(mach) * ConePressureCoefficient(mach, angle_rad);
}

double ConeLoading(double mach, double angle_rad) {
  return angle_rad > 0.0 ? kGamma * Square(mach) * Sin(2.0 * angle_rad) : 0.0;
}

double ConeShockLoss(double mach, double angle_rad) {
  const double k = mach * Sin(angle_rad);
  const double normal_mach = k * Sqrt(0.5 * (kGamma + 1.0) + 1.0 / Square(k));
  return ShockLoss(std::min(normal_mach, mach));
}

/// dp / d(Prandtl-Meyer angle) of a simple wave.
double WaveStrength(const Surface& s) {
  return kGamma * s.pressure * Square(s.mach) / Sqrt(Square(s.mach) - 1.0);
}

std::vector<Element> Elements(const std::vector<MouldSection>& body) {
  std::vector<Element> elements;
  for (const MouldSection& section : body) {
    const int count = section.IsCurved() ? kElementsOfCurve : 1;
    const double length_m = (section.end_m - section.start_m) / count;
    for (int i = 0; i < count; ++i) {
      const double start_m = section.start_m + i * length_m;
      const double radius_m = section.Radius(start_m);
      const double slope = (section.Radius(start_m + length_m) - radius_m) / length_m;
      elements.push_back({start_m, length_m, radius_m, slope, Atan(slope)});
    }
  }
  return elements;
}

/// Marches along the body and adds up its loads.
class March {
 public:
  explicit March(double mach) : mach_(mach) {}

  void Over(const Element& element) {
    const double cone_pressure = ConePressure(mach_, element.angle_rad);
    const double cone_loading = ConeLoading(mach_, element.angle_rad);
    double rate_per_m = 0.0;  // of the relaxation along the axis
    if (marching_) {
      Turn(element);
      rate_per_m = kRelaxationRate / (element.start_radius_m * Sqrt(Square(surface_.mach) - 1.0));
    } else {
      StartOnCone(element, cone_pressure, cone_loading);
    }
    AddLoads(element, cone_pressure, cone_loading, rate_per_m);
    const double left = Exp(-rate_per_m * element.length_m);
    surface_.pressure = cone_pressure + (surface_.pressure - cone_pressure) * left;
    surface_.loading_per_rad = cone_loading + (surface_.loading_per_rad - cone_loading) * left;
    surface_.mach = MachOfStagnationRatio(stagnation_ / surface_.pressure);
    marching_ = marching_ || surface_.mach >= kSlowestMach;
    surface_.mach = std::max(surface_.mach, kSlowestMach);
    angle_rad_ = element.angle_rad;
  }

  ShockExpansionResult Result() const { return result_; }

 private:
  /// Takes the surface around the corner ahead of an element. A compression too strong for attached flow
  /// ends at the slowest Mach number.
  void Turn(const Element& element) {
    const double turn_rad = angle_rad_ - element.angle_rad;
    Surface after;
    after.mach = std::max(kSlowestMach, MachOfPrandtlMeyer(PrandtlMeyer(surface_.mach) + turn_rad));
    after.pressure = stagnation_ / StagnationRatio(after.mach);
    after.loading_per_rad = surface_.loading_per_rad * WaveStrength(after) / WaveStrength(surface_);
    surface_ = after;
  }

  void StartOnCone(const Element& element, double cone_pressure, double cone_loading) {
    if (stagnation_ == 0.0) stagnation_ = StagnationRatio(mach_) * ConeShockLoss(mach_, element.angle_rad);
    surface_.pressure = cone_pressure;
    surface_.loading_per_rad = cone_loading;
  }

  void AddLoads(const Element& element, double cone_pressure, double cone_loading, double rate_per_m) {
    const double panel_m = element.length_m / kPanels;
    const double per_q = 1.0 / (0.5 * kGamma * Square(mach_));
    for (int i = 0; i <= kPanels; ++i) {
      const double weight = (i == 0 || i == kPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * panel_m / 3.0;
      const double along_m = i * panel_m;
      const double left = Exp(-rate_per_m * along_m);
      const double radius_m = element.start_radius_m + element.slope * along_m;
      const double pressure = cone_pressure + (surface_.pressure - cone_pressure) * left;
      const double loading = cone_loading + (surface_.loading_per_rad - cone_loading) * left;
      const double force_m2 = weight * kPi * radius_m * loading * per_q;
      result_.normal_force.area_m2 += force_m2;
      result_.normal_force.moment_m3 += force_m2 * (element.start_m + along_m);
      result_.pressure_drag_area_m2 += weight * kTwoPi * radius_m * element.slope * (pressure - 1.0) * per_q;
    }
  }

  double mach_;
  double stagnation_ = 0.0;  // of the surface streamline, over free-stream static pressure
  double angle_rad_ = 0.0;   // of the element before
  bool marching_ = false;
  Surface surface_{};
  ShockExpansionResult result_;
};

}  // namespace

double ConePressureCoefficient(double mach, double half_angle_rad) {
  if (!(half_angle_rad > 0.0)) return 0.0;
  const double sine = Sin(half_angle_rad);
  const double k = Sqrt(Square(mach) - 1.0) * sine;
  return 4.0 * Square(sine) * (2.5 + 8.0 * k) / (1.0 + 16.0 * k);
}

ShockExpansionResult ShockExpansion(const std::vector<MouldSection>& body, double mach) {
  DISPERSA_ASSERT(mach >= kShockExpansionMach, mach);
  March march(mach);
  for (const Element& element : Elements(body)) march.Over(element);
  return march.Result();
}

}  // namespace dispersa
