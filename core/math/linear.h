// Fixed-size linear algebra. Vectors carry their frames in their names (pages/words.md): v_IB_I is the
// velocity of B relative to I, expressed in I.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace dispersa {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix2 = Eigen::Matrix2d;
using Vector2 = Eigen::Vector2d;

}  // namespace dispersa
