#include "core/environment/turbulence.h"

#include <algorithm>
#include <cmath>

#include "core/environment/wind.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {
namespace {

constexpr double kFoot_m = 0.3048;

// Figure 7, ft/s (tests/data/wind): a row a curve, from often to seldom.
constexpr double kLog10Exceedance[] = {-0.6989700043360187, -1.0, -2.0, -3.0, -4.0, -5.0, -6.0};
constexpr double kFigureAltitude_ft[] = {500.0,   1750.0,  3750.0,  7500.0,  15000.0, 25000.0,
                                         35000.0, 45000.0, 55000.0, 65000.0, 75000.0, 80000.0};
constexpr int kCurves = 7, kColumns = 12;
constexpr double kFigure_ft_s[kCurves][kColumns] = {
    {3.2, 2.2, 1.5, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {4.2, 3.6, 3.3, 1.6, 0, 0, 0, 0, 0, 0, 0, 0},
    {6.6, 6.9, 7.4, 6.7, 4.6, 2.7, 0.4, 0, 0, 0, 0, 0},
    {8.6, 9.6, 10.6, 10.1, 8.0, 6.6, 5.0, 4.2, 2.7, 0, 0, 0},
    {11.8, 13.0, 16.0, 15.1, 11.6, 9.7, 8.1, 8.2, 7.9, 4.9, 3.2, 2.1},
    {15.6, 17.6, 23.0, 23.6, 22.1, 20.0, 16.0, 15.1, 12.1, 7.9, 6.2, 5.1},
    {18.7, 21.5, 28.4, 30.2, 30.7, 31.0, 25.2, 23.1, 17.5, 10.7, 8.4, 7.2},
};
constexpr double kFigureTop_m = 80000.0 * kFoot_m;

// Heights over the ground between which the models take turns, and where the lower one begins.
constexpr double kLowest_ft = 10.0, kLow_ft = 1000.0, kHigh_ft = 2000.0;
constexpr double kHighLength_m = 1750.0 * kFoot_m;

double LinearAt(const double* x, const double* y, int count, double at) {
  if (at <= x[0]) return y[0];
  for (int i = 1; i < count; ++i)
    if (at <= x[i]) return y[i - 1] + (y[i] - y[i - 1]) * ((at - x[i - 1]) / (x[i] - x[i - 1]));
  return y[count - 1];
}

TurbulenceScales LowAltitude(double wind_20ft_m_s, double height_ft) {
  const double shape = 0.177 + 0.000823 * height_ft;
  const double vertical = 0.1 * wind_20ft_m_s;
  return {vertical / Pow(shape, 0.4), vertical, kFoot_m * height_ft / Pow(shape, 1.2), kFoot_m * height_ft};
}

TurbulenceScales HighAltitude(double exceedance, double altitude_m) {
  const double sigma = TurbulenceIntensity(exceedance, altitude_m);
  return {sigma, sigma, kHighLength_m, kHighLength_m};
}

constexpr double kNodesALength = 50.0, kLeastSpacing_m = 2.0;
// A path that hardly climbs is nothing to lay a field over altitude along.
constexpr double kLeastSine = 0.05;

}  // namespace

double TurbulenceIntensity(double exceedance, double altitude_m) {
  double of_curve[kCurves], descending[kCurves];
  for (int i = 0; i < kCurves; ++i) {
    of_curve[i] = LinearAt(kFigureAltitude_ft, kFigure_ft_s[i], kColumns, altitude_m / kFoot_m);
    descending[i] = -kLog10Exceedance[i];
  }
  const double seldom = -Log10(exceedance);
  return kFoot_m * LinearAt(descending, of_curve, kCurves, seldom);
}

TurbulenceScales TurbulenceAt(const TurbulenceStrength& strength, double ground_m, double altitude_m) {
  const double height_ft = (altitude_m - ground_m) / kFoot_m;
  TurbulenceScales s;
  if (height_ft >= kHigh_ft) {
    s = HighAltitude(strength.exceedance, altitude_m);
  } else {
    s = LowAltitude(strength.wind_20ft_m_s, Clamp(height_ft, kLowest_ft, kLow_ft));
    if (height_ft > kLow_ft) {
      const TurbulenceScales above = HighAltitude(strength.exceedance, ground_m + kHigh_ft * kFoot_m);
      const double part = (height_ft - kLow_ft) / (kHigh_ft - kLow_ft);
      s.sigma_horizontal_m_s += part * (above.sigma_horizontal_m_s - s.sigma_horizontal_m_s);
      s.sigma_vertical_m_s += part * (above.sigma_vertical_m_s - s.sigma_vertical_m_s);
      s.length_horizontal_m += part * (above.length_horizontal_m - s.length_horizontal_m);
      s.length_vertical_m += part * (above.length_vertical_m - s.length_vertical_m);
    }
  }
  const double fade = strength.scale * Clamp(1.0 - (altitude_m - kFigureTop_m) / kWindFade_m, 0.0, 1.0);
  s.sigma_horizontal_m_s *= fade;
  s.sigma_vertical_m_s *= fade;
  return s;
}

TurbulencePath::TurbulencePath(const ClimbPath& path) {
  DISPERSA_ASSERT(IsStrictlyIncreasing(path.altitude_m) && path.sine_angle.size() == path.altitude_m.size(),
                  path.sine_angle.size(), path.altitude_m.size());
  const SinCos azimuth = SineCosine(path.azimuth_rad);
  azimuth_sine_ = azimuth.sin;
  azimuth_cosine_ = azimuth.cos;
  const double ground_m = path.altitude_m.front();
  const double top_m = std::min(path.altitude_m.back(), kFigureTop_m + kWindFade_m);
  double altitude_m = ground_m, spacing_m = 0.0;
  for (;;) {
    const GridPosition at = Locate(path.altitude_m, altitude_m);
    const double sine =
        Clamp((1.0 - at.fraction) * path.sine_angle[at.index] + at.fraction * path.sine_angle[at.index + 1],
              kLeastSine, 1.0);
    const TurbulenceScales scales = TurbulenceAt({kLargestExceedance, 0.0, 1.0}, ground_m, altitude_m);
    Node node{altitude_m, sine, Sqrt(1.0 - sine * sine), 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    // Stationary covariance of the two states across, [1 1/2; 1/2 1/2], less what the last node leaves of it.
    double e2 = 0.0, ratio = 0.0;
    if (!nodes_.empty()) {
      node.along_keeps = Exp(-spacing_m / scales.length_vertical_m);
      node.along_renews = Sqrt(1.0 - node.along_keeps * node.along_keeps);
      ratio = spacing_m / scales.length_horizontal_m;
      node.across_keeps = Exp(-ratio);
      node.across_ratio = ratio;
      e2 = node.across_keeps * node.across_keeps;
    }
    const double q11 = 1.0 - e2, q21 = 0.5 - e2 * (ratio + 0.5);
    const double q22 = 0.5 - e2 * (ratio * ratio + ratio + 0.5);
    node.renews_11 = Sqrt(q11);
    node.renews_21 = q21 / node.renews_11;
    node.renews_22 = Sqrt(std::max(0.0, q22 - node.renews_21 * node.renews_21));
    nodes_.push_back(node);
    if (altitude_m >= top_m) return;
    spacing_m = std::max(kLeastSpacing_m, scales.length_vertical_m / kNodesALength);
    altitude_m += sine * spacing_m;
  }
}

TurbulentWind Evaluate(const TurbulenceField& field, double altitude_m) {
  if (field.altitude_m.empty() || altitude_m >= field.altitude_m.back()) return {};
  const GridPosition at = Locate(field.altitude_m, altitude_m);
  const auto between = [&](const std::vector<double>& values) {
    return (1.0 - at.fraction) * values[at.index] + at.fraction * values[at.index + 1];
  };
  return {between(field.north_m_s), between(field.east_m_s), between(field.up_m_s)};
}

TurbulenceField DrawTurbulence(const TurbulenceStrength& strength, const TurbulencePath& path,
                               const TurbulenceNormals& draw) {
  // With the states x1' = -x1 + w and x2' = -x2 + x1 over the length, (sqrt 3 x1 + (1 - sqrt 3) x2) / sqrt 2
  // has the lateral spectrum and the deviation 1.
  static const double root3 = Sqrt(3.0), root2 = Sqrt(2.0);
  const double of_first = root3 / root2, of_second = (1.0 - root3) / root2;
  struct Lateral {
    double first = 0.0, second = 0.0;
  };
  const auto advance = [](const TurbulencePath::Node& node, const std::function<double()>& normal,
                          Lateral& x) {
    const double one = normal(), two = normal();
    x.second = node.across_keeps * (node.across_ratio * x.first + x.second) + node.renews_21 * one +
               node.renews_22 * two;
    x.first = node.across_keeps * x.first + node.renews_11 * one;
  };
  const std::size_t count = path.nodes().size();
  TurbulenceField field;
  for (std::vector<double>* values : {&field.altitude_m, &field.north_m_s, &field.east_m_s, &field.up_m_s})
    values->reserve(count);
  double along_state = 0.0;
  Lateral across_state, normal_state;
  for (const TurbulencePath::Node& node : path.nodes()) {
    along_state = node.along_keeps * along_state + node.along_renews * draw.along();
    advance(node, draw.across, across_state);
    advance(node, draw.normal, normal_state);
    const TurbulenceScales s = TurbulenceAt(strength, path.ground_m(), node.altitude_m);
    const double along = s.sigma_vertical_m_s * along_state;
    const double across =
        s.sigma_horizontal_m_s * (of_first * across_state.first + of_second * across_state.second);
    const double normal =
        s.sigma_horizontal_m_s * (of_first * normal_state.first + of_second * normal_state.second);
    const double downrange = node.cosine * along - node.sine * normal;
    field.altitude_m.push_back(node.altitude_m);
    field.north_m_s.push_back(path.azimuth_cosine() * downrange - path.azimuth_sine() * across);
    field.east_m_s.push_back(path.azimuth_sine() * downrange + path.azimuth_cosine() * across);
    field.up_m_s.push_back(node.sine * along + node.cosine * normal);
  }
  return field;
}

}  // namespace dispersa
