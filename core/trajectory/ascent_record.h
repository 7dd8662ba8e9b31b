// One ascent at one instant, and its record.
#pragma once

#include "core/flight/launch_frame.h"
#include "core/math/lane_eigen.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/point_mass.h"

namespace dispersa {

struct AscentPoint {
  lanes::Leg<double> leg;
  double time_s;
  int stage;  ///< 1-based
  lanes::Vector<double> p, v;
};

lanes::AscentInstant<double> InstantOf(const lanes::Ground& ground, const AscentPoint& point);
lanes::Vector<double> ForwardOf(const lanes::Ground& ground, const AscentPoint& point);
lanes::Vector<double> AxisRateOf(const lanes::Ground& ground, const AscentPoint& point);
/// Body axes in I: x along `forward_I`, y as near as possible to the launch frame's y. There is then no roll
/// in L.
Matrix3 AttitudeOf(const LaunchFrame& frame, const lanes::Vector<double>& forward_I);

/// Appends a sample, and a knot of the attitude program if it has none at this time.
void Record(const LaunchFrame& frame, const lanes::Ground& ground, const AscentPoint& point,
            const lanes::AscentInstant<double>& now, AscentResult* result);

}  // namespace dispersa
