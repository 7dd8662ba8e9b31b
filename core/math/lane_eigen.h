// Between Eigen's vectors and those of one lane. Not for what is compiled for several instruction sets
// (core/math/lanes.h): Eigen's functions would be linked from any of them.
#pragma once

#include "core/math/lane_vector.h"
#include "core/math/linear.h"

namespace dispersa {

inline lanes::Vector<double> ToLanes(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
inline Vector3 ToEigen(const lanes::Vector<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace dispersa
