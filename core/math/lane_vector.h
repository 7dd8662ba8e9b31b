// Vectors and quaternions of lanes (core/math/lanes.h), for models that are flown side by side. Conventions
// as in core/math/rotation.h.
#pragma once

#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
struct Vector {
  T x, y, z;

  DISPERSA_INLINE T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  DISPERSA_INLINE const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend DISPERSA_INLINE Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend DISPERSA_INLINE Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend DISPERSA_INLINE Vector operator*(T k, Vector a) { return {k * a.x, k * a.y, k * a.z}; }
};
template <class T>
DISPERSA_INLINE Vector<T> Zero() {
  return {T(0.0), T(0.0), T(0.0)};
}
/// Of three numbers.
DISPERSA_INLINE Vector<double> VectorAt(const double* v) { return {v[0], v[1], v[2]}; }
/// a + k b.
template <class T>
DISPERSA_INLINE Vector<T> Along(Vector<T> a, T k, Vector<T> b) {
  return {Fma(k, b.x, a.x), Fma(k, b.y, a.y), Fma(k, b.z, a.z)};
}
template <class T>
DISPERSA_INLINE T Dot(Vector<T> a, Vector<T> b) {
  return Fma(a.x, b.x, Fma(a.y, b.y, a.z * b.z));
}
template <class T>
DISPERSA_INLINE Vector<T> Cross(Vector<T> a, Vector<T> b) {
  return {Fma(a.y, b.z, -(a.z * b.y)), Fma(a.z, b.x, -(a.x * b.z)), Fma(a.x, b.y, -(a.y * b.x))};
}
template <class T>
DISPERSA_INLINE Vector<T> Select(MaskOf<T> m, Vector<T> yes, Vector<T> no) {
  return {Select(m, yes.x, no.x), Select(m, yes.y, no.y), Select(m, yes.z, no.z)};
}

/// Rows of a matrix.
template <class T>
struct Matrix {
  Vector<T> row[3];

  friend DISPERSA_INLINE Vector<T> operator*(const Matrix& m, Vector<T> v) {
    return {Dot(m.row[0], v), Dot(m.row[1], v), Dot(m.row[2], v)};
  }
};
/// Of nine numbers, column by column.
DISPERSA_INLINE Matrix<double> MatrixAt(const double* m) {
  return {{{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}}};
}
/// Transposed times v.
template <class T>
DISPERSA_INLINE Vector<T> TransposeTimes(const Matrix<T>& m, Vector<T> v) {
  return {Fma(m.row[0].x, v.x, Fma(m.row[1].x, v.y, m.row[2].x * v.z)),
          Fma(m.row[0].y, v.x, Fma(m.row[1].y, v.y, m.row[2].y * v.z)),
          Fma(m.row[0].z, v.x, Fma(m.row[1].z, v.y, m.row[2].z * v.z))};
}

template <class T>
struct Turn {  ///< unit quaternion
  T w, x, y, z;
};
/// q_AC of q_AB and q_BC.
template <class T>
DISPERSA_INLINE Turn<T> Compose(Turn<T> a, Turn<T> b) {
  return {Fma(a.w, b.w, -Fma(a.x, b.x, Fma(a.y, b.y, a.z * b.z))),
          Fma(a.w, b.x, Fma(a.x, b.w, Fma(a.y, b.z, -(a.z * b.y)))),
          Fma(a.w, b.y, Fma(a.y, b.w, Fma(a.z, b.x, -(a.x * b.z)))),
          Fma(a.w, b.z, Fma(a.z, b.w, Fma(a.x, b.y, -(a.y * b.x))))};
}
template <class T>
DISPERSA_INLINE Turn<T> Inverse(Turn<T> q) {
  return {q.w, -q.x, -q.y, -q.z};
}
template <class T>
DISPERSA_INLINE Matrix<T> RotationMatrix(Turn<T> q) {
  const T xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const T xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const T wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  const T one(1.0), two(2.0), minus_two(-2.0);
  return {{{Fma(minus_two, yy + zz, one), two * (xy - wz), two * (xz + wy)},
           {two * (xy + wz), Fma(minus_two, xx + zz, one), two * (yz - wx)},
           {two * (xz - wy), two * (yz + wx), Fma(minus_two, xx + yy, one)}}};
}
/// Components in A of a vector given in B.
template <class T>
DISPERSA_INLINE Vector<T> Rotate(Turn<T> q, Vector<T> v) {
  const Vector<T> u{q.x, q.y, q.z};
  const Vector<T> t = Cross(u, v) + Cross(u, v);
  return Along(v, q.w, t) + Cross(u, t);
}

/// q turned by the rotation vector phi (rad, axes of B), shorter than 0.5 rad. The half angle's sine and
/// cosine come from their series, with a remainder below 1e-17. One Newton step restores the norm, which is
/// off by rounding only.
template <class T>
DISPERSA_INLINE Turn<T> TurnedBy(Turn<T> q, Vector<T> phi) {
  const T n = Dot(phi, phi);
  const T sine = Horner(n, 0.5, -1.0 / 48, 1.0 / 3840, -1.0 / 645120, 1.0 / 185794560);
  const T cosine = Horner(n, 1.0, -1.0 / 8, 1.0 / 384, -1.0 / 46080, 1.0 / 10321920, -1.0 / 3715891200);
  const Turn<T> r = Compose(q, {cosine, sine * phi.x, sine * phi.y, sine * phi.z});
  const T norm2 = Fma(r.w, r.w, Fma(r.x, r.x, Fma(r.y, r.y, r.z * r.z)));
  const T k = Fma(T(-0.5), norm2, T(1.5));
  return {k * r.w, k * r.x, k * r.y, k * r.z};
}

/// Rotation vector (rad) of q, of length at most pi. Near zero it uses the series of the arctangent,
/// elsewhere SLEEF's function. Both are within a few units in the last place.
template <class T>
DISPERSA_INLINE Vector<T> RotationVector(Turn<T> q) {
  const T sign = Select(q.w < T(0.0), T(-1.0), T(1.0));
  const T w = q.w * sign, x = q.x * sign, y = q.y * sign, z = q.z * sign;
  const T sine2 = Fma(x, x, Fma(y, y, z * z));
  const auto is_small = sine2 < T(1.0 / 64.0) * w * w;
  const T inverse = T(1.0) / Select(is_small, w, T(1.0));
  const T tangent2 = sine2 * inverse * inverse;
  T factor =
      T(2.0) * inverse *
      Horner(tangent2, 1.0, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15, 1.0 / 17);
  if (!All(is_small)) {
    const T sine = Sqrt(sine2);
    factor = Select(is_small, factor, T(2.0) * Atan2(sine, w) / Select(sine > T(0.0), sine, T(1.0)));
  }
  return {factor * x, factor * y, factor * z};
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
