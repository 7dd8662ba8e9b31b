// Masses off the vehicle's axis, of W vehicles side by side (core/math/lanes.h): boosters that are bodies of
// their own, and stages whose mass tables say so. Frames and signs as in launcher_body.h.
#pragma once

#include "core/math/lane_vector.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Sums over bodies off the axis; stations count aft.
template <class T>
struct OffAxis {
  T y_kg_m, z_kg_m;                    ///< of mass times place
  T station_y_kg_m2, station_z_kg_m2;  ///< of mass times station times place
  T about_y_kg_m2, yz_kg_m2;           ///< what I_y has more than the mean of I_y and I_z; sum of m y z
};

/// Stages with tables that know masses off the axis (SideSums).
template <class T>
struct SideMasses {
  T fixed[kSideSums];                ///< of all but the burning propellant
  const MassRows* table[kWidth<T>];  ///< null: none has side rows
  OffAxis<T> now;
};
template <class T>
DISPERSA_INLINE void SetSides(SideMasses<T>& s, int lane, const StackMass& mass) {
  const double* const sums = mass.sides.data();
  for (int k = 0; k < kSideSums; ++k) Lane(s.fixed[k], lane) = sums[k];
  s.table[lane] = mass.table != nullptr && mass.table->side_rows.size() > 0 ? mass.table : nullptr;
}
template <class T>
DISPERSA_INLINE void SidesAt(const SideMasses<T>& s, T propellant_kg, T* sums) {
  const double* piece[kWidth<T>];
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    const MassRows* const table = s.table[lane];
    piece[lane] = table == nullptr
                      ? kNoMassRow
                      : table->side_rows.data() +
                            MassRows::kSideRowSize * MassPieceAt(*table, Lane(propellant_kg, lane));
  }
  T row[MassRows::kSideRowSize];
  LoadRow(piece, MassRows::kSideRowSize / 4, row);
  const T from = propellant_kg - row[0];
  for (int k = 0; k < kSideSums; ++k) sums[k] = s.fixed[k] + Fma(from, row[2 + 2 * k], row[1 + 2 * k]);
}
/// `m` with what they weigh off the axis, and that in `now`. By value: a reference would keep `m` in memory
/// for other vehicles too.
template <class T>
DISPERSA_OUT_OF_LINE MassPropertiesOf<T> WithSides(SideMasses<T>& sides, T propellant_kg,
                                                   MassPropertiesOf<T> m) {
  T sums[kSideSums];
  SidesAt(sides, propellant_kg, sums);
  sides.now = {sums[kSideY],        sums[kSideZ],      sums[kSideStationY],
               sums[kSideStationZ], sums[kSideAboutY], sums[kSideYz]};
  m.axial_inertia_kg_m2 = m.axial_inertia_kg_m2 + sums[kSideSquare];
  m.transverse_inertia_kg_m2 = Fma(T(0.5), sums[kSideSquare], m.transverse_inertia_kg_m2);
  return m;
}

/// The tensor of inertia about C.
template <class T>
struct Tensor {
  T xx, yy, zz;
  T xy, xz, yz;  ///< integrals of the products: the off-diagonal elements are their negatives
};
/// Of axial and transverse moments of a body of which the masses off the axis count as spread about it.
/// `factor`: by which the flight's moments of inertia differ.
template <class T>
DISPERSA_INLINE Tensor<T> TensorOf(const OffAxis<T>& off, T axial_kg_m2, T transverse_kg_m2, T mass_kg,
                                   T cg_station_m, T factor) {
  const T y = off.y_kg_m / mass_kg, z = off.z_kg_m / mass_kg;
  const T yy = off.y_kg_m * y, zz = off.z_kg_m * z;
  return {axial_kg_m2 - factor * (yy + zz),
          transverse_kg_m2 + factor * (off.about_y_kg_m2 - zz),
          transverse_kg_m2 - factor * (off.about_y_kg_m2 + yy),
          factor * Fma(cg_station_m, off.y_kg_m, -off.station_y_kg_m2),
          factor * Fma(cg_station_m, off.z_kg_m, -off.station_z_kg_m2),
          factor * Fma(-off.y_kg_m, z, off.yz_kg_m2)};
}

template <class T>
DISPERSA_INLINE Vector<T> operator*(const Tensor<T>& i, const Vector<T>& v) {
  return {i.xx * v.x - (i.xy * v.y + i.xz * v.z), i.yy * v.y - (i.xy * v.x + i.yz * v.z),
          i.zz * v.z - (i.xz * v.x + i.yz * v.y)};
}
/// dw/dt of I dw/dt = `moment` - w x I w, by cofactors of I.
template <class T>
DISPERSA_INLINE Vector<T> TurnedUnder(const Tensor<T>& i, const Vector<T>& moment, const Vector<T>& w) {
  const Vector<T> m = moment - Cross(w, i * w);
  const T c_xx = i.yy * i.zz - i.yz * i.yz, c_yy = i.xx * i.zz - i.xz * i.xz,
          c_zz = i.xx * i.yy - i.xy * i.xy;
  const T c_xy = i.xy * i.zz + i.xz * i.yz, c_xz = i.xz * i.yy + i.xy * i.yz,
          c_yz = i.xx * i.yz + i.xy * i.xz;
  const T inverse = T(1.0) / (i.xx * c_xx - (i.xy * c_xy + i.xz * c_xz));
  return inverse * Vector<T>{c_xx * m.x + c_xy * m.y + c_xz * m.z, c_xy * m.x + c_yy * m.y + c_yz * m.z,
                             c_xz * m.x + c_yz * m.y + c_zz * m.z};
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
