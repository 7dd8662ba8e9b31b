// Filters of the autopilot's commands: second-order sections, continuous in files, discrete in flight.
#pragma once

#include "core/control/autopilot_config.h"

namespace dispersa {

/// y(k) = b0 x(k) + b1 x(k-1) + b2 x(k-2) - a1 y(k-1) - a2 y(k-2); without a filter y = x.
template <class T>
struct DigitalSectionOf {
  T b0 = T(1.0), b1 = T(0.0), b2 = T(0.0), a1 = T(0.0), a2 = T(0.0);
};
using DigitalSection = DigitalSectionOf<double>;

/// By the bilinear transform, prewarped so that the poles' frequency is kept; it must be below half of the
/// sampling's (K. J. Astrom and B. Wittenmark, "Computer-Controlled Systems", 8.2).
DigitalSection Discretise(const FilterSection& section, double tick_s);

}  // namespace dispersa
