#include "core/math/rotation.h"

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quaternion Normalized(const Quaternion& q) {
  const double norm = Sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
}

Matrix3 RotationMatrix(const Quaternion& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  Matrix3 R;
  R << 1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy), 2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz),
      2.0 * (yz - wx), 2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy);
  return R;
}

Quaternion QuaternionOf(const Matrix3& R) {
  const double trace = R(0, 0) + R(1, 1) + R(2, 2);
  Quaternion q;
  if (trace >= R(0, 0) && trace >= R(1, 1) && trace >= R(2, 2)) {
    q = {1.0 + trace, R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)};
  } else if (R(0, 0) >= R(1, 1) && R(0, 0) >= R(2, 2)) {
    q = {R(2, 1) - R(1, 2), 1.0 + R(0, 0) - R(1, 1) - R(2, 2), R(0, 1) + R(1, 0), R(0, 2) + R(2, 0)};
  } else if (R(1, 1) >= R(2, 2)) {
    q = {R(0, 2) - R(2, 0), R(0, 1) + R(1, 0), 1.0 - R(0, 0) + R(1, 1) - R(2, 2), R(1, 2) + R(2, 1)};
  } else {
    q = {R(1, 0) - R(0, 1), R(0, 2) + R(2, 0), R(1, 2) + R(2, 1), 1.0 - R(0, 0) - R(1, 1) + R(2, 2)};
  }
  if (q.w < 0.0) q = {-q.w, -q.x, -q.y, -q.z};
  return Normalized(q);
}

Vector3 Rotate(const Quaternion& q, const Vector3& v) {
  const Vector3 u(q.x, q.y, q.z);
  const Vector3 t = 2.0 * u.cross(v);
  return v + q.w * t + u.cross(t);
}

Quaternion Derivative(const Quaternion& q, const Vector3& w) {
  const Quaternion rate = q * Quaternion{0.0, w.x(), w.y(), w.z()};
  return {0.5 * rate.w, 0.5 * rate.x, 0.5 * rate.y, 0.5 * rate.z};
}

Vector3 RotationVector(const Quaternion& q_in) {
  const Quaternion q = q_in.w < 0.0 ? Quaternion{-q_in.w, -q_in.x, -q_in.y, -q_in.z} : q_in;
  const Vector3 u(q.x, q.y, q.z);
  const double sine = u.norm();
  // Below this sine the quotient angle / sine equals 2 to the last bit.
  if (sine < 1e-9) return 2.0 * u;
  return (2.0 * Atan2(sine, q.w) / sine) * u;
}

Quaternion FromRotationVector(const Vector3& phi) {
  const double angle = phi.norm();
  if (angle < 1e-9) return Normalized({1.0, 0.5 * phi.x(), 0.5 * phi.y(), 0.5 * phi.z()});
  const SinCos half = SineCosine(0.5 * angle);
  const double k = half.sin / angle;
  return {half.cos, k * phi.x(), k * phi.y(), k * phi.z()};
}

namespace {

Quaternion AboutX(double angle) {
  const SinCos half = SineCosine(0.5 * angle);
  return {half.cos, half.sin, 0.0, 0.0};
}
Quaternion AboutY(double angle) {
  const SinCos half = SineCosine(0.5 * angle);
  return {half.cos, 0.0, half.sin, 0.0};
}
Quaternion AboutZ(double angle) {
  const SinCos half = SineCosine(0.5 * angle);
  return {half.cos, 0.0, 0.0, half.sin};
}

}  // namespace

Quaternion FromYawPitchRoll(const YawPitchRoll& angles) {
  return AboutZ(angles.yaw) * AboutY(angles.pitch) * AboutX(angles.roll);
}

YawPitchRoll ToYawPitchRoll(const Quaternion& q) {
  const Matrix3 R = RotationMatrix(q);
  const double sine = Clamp(-R(2, 0), -1.0, 1.0);
  if (1.0 - (sine < 0.0 ? -sine : sine) < kSingularSine)
    return {0.0, Asin(sine), Atan2(sine > 0.0 ? R(0, 1) : -R(0, 1), R(1, 1))};
  return {Atan2(R(1, 0), R(0, 0)), Atan2(sine, Sqrt(R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0))),
          Atan2(R(2, 1), R(2, 2))};
}

Quaternion FromPitchYawRoll(const PitchYawRoll& angles) {
  return AboutY(angles.pitch) * AboutZ(angles.yaw) * AboutX(angles.roll);
}

PitchYawRoll ToPitchYawRoll(const Quaternion& q) {
  const Matrix3 R = RotationMatrix(q);
  const double sine = Clamp(R(1, 0), -1.0, 1.0);
  if (1.0 - (sine < 0.0 ? -sine : sine) < kSingularSine)
    return {0.0, Asin(sine), Atan2(sine > 0.0 ? R(0, 2) : -R(0, 2), R(2, 2))};
  return {Atan2(-R(2, 0), R(0, 0)), Atan2(sine, Sqrt(R(0, 0) * R(0, 0) + R(2, 0) * R(2, 0))),
          Atan2(-R(1, 2), R(1, 1))};
}

}  // namespace dispersa
