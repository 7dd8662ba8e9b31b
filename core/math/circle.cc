#include "core/math/circle.h"

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

/// n R^2 of n values with the mean resultant length R. Uniform values exceed it once in a thousand samples:
/// exp(-7).
constexpr double kChance = 7.0;

struct Resultant {
  double n = 0.0, cosines = 0.0, sines = 0.0;

  double angle_rad() const { return Atan2(sines, cosines); }
};

Resultant ResultantOf(const std::vector<double>& values, const Circle& circle) {
  Resultant sum;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const SinCos unit = SineCosine(kTwoPi * (value / circle.turn));
    sum.n += 1.0;
    sum.cosines += unit.cos;
    sum.sines += unit.sin;
  }
  return sum;
}

/// Values within half a turn leave a gap of half a turn.
bool LieWithinHalfATurn(const std::vector<double>& values, const Circle& circle) {
  std::vector<double> places;
  for (const double value : values)
    if (std::isfinite(value)) places.push_back(NearTo(circle.cut + 0.5 * circle.turn, value, circle));
  std::sort(places.begin(), places.end());
  double gap = places.front() + circle.turn - places.back();
  for (std::size_t i = 1; i < places.size(); ++i) gap = std::max(gap, places[i] - places[i - 1]);
  return gap > 0.5 * circle.turn;
}

bool HasCentre(const Resultant& sum, const std::vector<double>& values, const Circle& circle) {
  const double square = sum.cosines * sum.cosines + sum.sines * sum.sines;
  return square > kChance * sum.n || LieWithinHalfATurn(values, circle);
}

}  // namespace

double NearTo(double centre, double value, const Circle& circle) {
  if (!circle.is_closed() || !std::isfinite(value)) return value;
  return value - circle.turn * std::floor((value - centre) / circle.turn + 0.5);
}

std::optional<double> CentreOf(const std::vector<double>& values, const Circle& circle) {
  if (!circle.is_closed()) return std::nullopt;
  const Resultant sum = ResultantOf(values, circle);
  if (sum.n == 0.0 || !HasCentre(sum, values, circle)) return std::nullopt;
  return NearTo(circle.cut + 0.5 * circle.turn, sum.angle_rad() / kTwoPi * circle.turn, circle);
}

bool LiesAllAround(const std::vector<double>& values, const Circle& circle) {
  if (!circle.is_closed()) return false;
  const Resultant sum = ResultantOf(values, circle);
  return sum.n > 0.0 && !HasCentre(sum, values, circle);
}

std::vector<double> Unwrapped(std::vector<double> values, const Circle& circle) {
  const std::optional<double> centre = CentreOf(values, circle);
  if (!centre) return values;
  for (double& value : values) value = NearTo(*centre, value, circle);
  return values;
}

}  // namespace dispersa
