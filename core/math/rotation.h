// Rotations: quaternions, the two Euler sequences that the product uses, and rotation vectors.
#pragma once

#include "core/math/linear.h"

namespace dispersa {

/// Unit quaternion q_AB = w + x i + y j + z k that takes components in B to components in A:
/// v_A = Rotate(q_AB, v_B). Hamilton convention.
struct Quaternion {
  double w = 1.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// q_AC = q_AB * q_BC.
Quaternion operator*(const Quaternion& q_AB, const Quaternion& q_BC);
/// q_BA from q_AB.
inline Quaternion Inverse(const Quaternion& q_AB) { return {q_AB.w, -q_AB.x, -q_AB.y, -q_AB.z}; }
Quaternion Normalized(const Quaternion& q);
/// R_AB, shape (3, 3), of a unit quaternion.
Matrix3 RotationMatrix(const Quaternion& q_AB);
/// The unit quaternion of a proper rotation matrix (Shepperd's method), w >= 0.
Quaternion QuaternionOf(const Matrix3& R_AB);
/// Components in A of a vector given in B.
Vector3 Rotate(const Quaternion& q_AB, const Vector3& v_B);
/// dq_AB/dt for the angular velocity w_AB_B (rad/s) of B relative to A, in B.
Quaternion Derivative(const Quaternion& q_AB, const Vector3& w_AB_B);

/// Rotation vector (rad) of q, of length at most pi.
Vector3 RotationVector(const Quaternion& q);
Quaternion FromRotationVector(const Vector3& phi_rad);

/// Yaw, pitch and roll (rad) of the 3-2-1 sequence: R_AB = Rz(yaw) Ry(pitch) Rx(roll).
/// Singular at pitch = ±90°, where yaw is returned as 0 and roll takes the whole turn.
struct YawPitchRoll {
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};
Quaternion FromYawPitchRoll(const YawPitchRoll& angles);
YawPitchRoll ToYawPitchRoll(const Quaternion& q_AB);

/// Pitch, yaw and roll (rad) of the 2-3-1 sequence: R_AB = Ry(pitch) Rz(yaw) Rx(roll).
/// Regular at lift-off (pitch = 90°), singular at yaw = ±90°.
struct PitchYawRoll {
  double pitch = 0.0;
  double yaw = 0.0;
  double roll = 0.0;
};
Quaternion FromPitchYawRoll(const PitchYawRoll& angles);
PitchYawRoll ToPitchYawRoll(const Quaternion& q_AB);

}  // namespace dispersa
