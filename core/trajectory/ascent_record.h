// One ascent at one instant, and what is recorded of it.
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
/// Body axes in I: x forward, y as near to the launch frame's y as possible, so there is no roll in L.
Matrix3 AttitudeOf(const LaunchFrame& frame, const lanes::Vector<double>& forward_I);

/// Appends a sample, and a knot of the attitude program unless it has one at this time.
void Record(const LaunchFrame& frame, const lanes::Ground& ground, const AscentPoint& point,
            const lanes::AscentInstant<double>& now, AscentResult* result);

}  // namespace dispersa
