// The mass of a spread body within one element of the beam.
#pragma once

#include <cmath>

#include "core/structure/beam_elements.h"

namespace dispersa {

/// Boundaries that are nearer to each other than this are one.
inline constexpr double kSameStation_m = 1e-6;

/// f(weight, fraction) over the points of Gauss's rule that is exact up to degree 9. The weights sum to 1.
template <typename F>
void GaussFive(F f) {
  constexpr double kPoint[3] = {0.0, 0.53846931010568309104, 0.90617984593866399280};
  constexpr double kWeight[3] = {0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
  f(0.5 * kWeight[0], 0.5);
  for (const int i : {1, 2}) {
    f(0.5 * kWeight[i], 0.5 - 0.5 * kPoint[i]);
    f(0.5 * kWeight[i], 0.5 + 0.5 * kPoint[i]);
  }
}

/// The part of an element that a spread mass covers, in fractions of its length; none if both are 0.
struct CoveredPart {
  double from = 0.0, to = 0.0;
};

/// A liquid's surface falls through elements: one counts as far as it is wet. Other masses end at nodes.
inline CoveredPart PartCovered(const SpreadMass& m, double top_station_m, double h) {
  const double ahead_m = m.top_station_m - top_station_m, along_m = m.bottom_station_m - top_station_m;
  if (ahead_m > h - kSameStation_m || along_m < kSameStation_m) return {};
  const double from = ahead_m > kSameStation_m ? ahead_m / h : 0.0;
  const double to = along_m < h - kSameStation_m ? along_m / h : 1.0;
  return {from, to};
}

/// f(mass_kg, gyration2_m2, shape) over points of the covered part.
template <typename F>
void ForEachMassOf(const SpreadMass& m, const CoveredPart& part, double top_station_m,
                   const BeamElement& element, F f) {
  const double h = element.length_m;
  GaussFive([&](double of_part, double within) {
    const double weight = of_part * (part.to - part.from), x = part.from + (part.to - part.from) * within;
    const double station = top_station_m + x * h;
    f(weight * h * m.MassPerLength(station), m.Gyration2(station), ShapeAt(x, h, element.shear_ratio));
  });
}

}  // namespace dispersa
