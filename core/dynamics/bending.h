// Bending of W launch vehicles side by side (core/math/lanes.h): modes of free-free beams (core/structure) in
// the mean axes of the body, to first order in the deflections.
//
// A mode of plane z moves station s by deflection(s) q along body z and turns the cross-section by slope(s) q
// about y. A mode of plane y moves it along y and turns it by -slope(s) q about z. In mean axes momentum and
// angular momentum are those of the rigid body (R. D. Milne, "Dynamics of the Deformable Aeroplane", ARC R&M
// 3345, 1964). So bending enters the body's equations through the forces alone. Each mode follows
//
//   q'' + 2 zeta omega q' + omega² q = Q / m
//
// with Q the sum of force deflection + moment slope over all forces but gravitation. Not modelled: Coriolis
// and centrifugal terms of the turning body (below 1e-4 of omega² at a roll rate of 10 deg/s), couples of the
// reaction control, and the change of shapes within a step.
#pragma once

#include "core/dynamics/body_sections.h"
#include "core/math/lane_vector.h"
#include "core/modes/mode_table.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// One mode at a lane's propellant, its flight's factors applied. A mode that does not fly has no shape.
template <class T>
struct ModeNow {
  T stiffness_1_s2, damping_1_s;        ///< omega², 2 zeta omega
  T decay_1_s, damped_frequency_rad_s;  ///< of the free motion
  T inverse_mass_1_kg;
};

/// The columns of one mode between two levels of propellant: `low` at the upper one, `rise` from there to the
/// next.
template <class T>
struct ModeRows {
  T low[ModeTable::kRowSize], rise[ModeTable::kRowSize];
  /// Of the columns of all load stations the largest absolute value, by inertia and by each cause of lift.
  struct Largest {
    T low, rise;
  } of_inertia, of_lift[kLiftCauses];
};

/// A number of plane y and of plane z.
template <class T>
struct OfPlanes {
  T y, z;
};

/// The bending of each lane's stack.
template <class T>
struct StackBending : BendingFactorsOf<T> {
  int modes = 0;   ///< of any stack: the same in all lanes, as
  int planes = 1;  ///< 1: plane z is plane y in every stack
  const ModeTable* table[kWidth<T>] = {};
  /// The levels that each lane is between, read from its table: the propellant of the upper one, by how much
  /// the next has less, and the range in which they stay the right ones (none: nothing is read yet).
  T level_kg, span_kg, from_kg, to_kg;
  ModeRows<T> rows[kPlanes][kModes];
  T within;  ///< 0 at the upper level, 1 at the next
  ModeNow<T> now[kPlanes][kModes];

  DISPERSA_INLINE const ModeNow<T>& At(int plane, int mode) const {
    return now[planes == 1 ? 0 : plane][mode];
  }
  DISPERSA_INLINE T ColumnAt(int plane, int mode, int column) const {
    const ModeRows<T>& of = rows[planes == 1 ? 0 : plane][mode];
    return Fma(within, of.rise[column], of.low[column]);
  }
  /// A column of both planes, looked up once where they are one.
  DISPERSA_INLINE OfPlanes<T> ColumnsAt(int mode, int column) const {
    const T y = ColumnAt(0, mode, column);
    return {y, planes == 1 ? y : ColumnAt(1, mode, column)};
  }
  /// Slopes that sensors feel: of the inertial unit, and of each gyro.
  DISPERSA_INLINE T UnitSlope(int plane, int mode) const {
    return this->slope_factor * ColumnAt(plane, mode, ModeTable::kUnitSlope);
  }
  DISPERSA_INLINE T GyroSlope(int plane, int mode, int gyro) const {
    return this->slope_factor * ColumnAt(plane, mode, ModeTable::kGyroSlope + gyro);
  }
};
/// The modes of another stack, or of one that has let go of a body (null: it is rigid).
template <class T>
DISPERSA_INLINE void SetTable(StackBending<T>& b, int lane, const ModeTable* table) {
  b.table[lane] = table != nullptr && table->modes > 0 ? table : nullptr;
  Lane(b.from_kg, lane) = Lane(b.to_kg, lane) = 0.0;
}

/// Modal coordinates (m) and their rates: plane y, plane z.
template <class T>
struct BendingState {
  T q_m[kPlanes][kModes], rate_m_s[kPlanes][kModes];
};
/// Q / m.
template <class T>
struct ModalForce {
  T drive_m_s2[kPlanes][kModes];
};

/// Of the columns of all load stations, from `first` on. Between the levels no column is larger than the same
/// mean of the largest ones.
template <class T>
DISPERSA_INLINE typename ModeRows<T>::Largest LargestColumn(const ModeRows<T>& rows, int first) {
  T low(0.0), high(0.0);
  for (int i = first; i < first + kLoadStations; ++i) {
    low = Max(low, Abs(rows.low[i]));
    high = Max(high, Abs(rows.low[i] + rows.rise[i]));
  }
  return {low, high - low};
}

/// Reads the levels about each lane's propellant. A flight needs it once for each level.
template <class T>
DISPERSA_OUT_OF_LINE void ReadLevels(StackBending<T>& b, T propellant_kg) {
  constexpr double kInfinity = __builtin_inf();
  alignas(128) static constexpr double kNone[ModeTable::kRowSize] = {};
  int level[kWidth<T>], next[kWidth<T>];
  for (int lane = 0; lane < kWidth<T>; ++lane) {
    level[lane] = next[lane] = 0;
    double level_kg = 0.0, span_kg = kInfinity, from_kg = kInfinity, to_kg = -kInfinity;
    if (b.table[lane] != nullptr) {
      const double* levels = b.table[lane]->propellant_kg.data();
      const int last = static_cast<int>(b.table[lane]->propellant_kg.size()) - 1;
      const double here = Lane(propellant_kg, lane);
      int at = 0;
      while (at < last - 1 && here < levels[at + 1]) ++at;
      level[lane] = next[lane] = at;
      level_kg = levels[at];
      if (last > 0) {
        next[lane] = at + 1;
        span_kg = levels[at] - levels[at + 1];
      }
      if (at > 0) from_kg = levels[at];
      if (at < last - 1) to_kg = levels[at + 1];
    }
    Lane(b.level_kg, lane) = level_kg;
    Lane(b.span_kg, lane) = span_kg;
    Lane(b.from_kg, lane) = from_kg;
    Lane(b.to_kg, lane) = to_kg;
  }
  for (int plane = 0; plane < b.planes; ++plane) {
    for (int mode = 0; mode < b.modes; ++mode) {
      const double *low[kWidth<T>], *high[kWidth<T>];
      for (int lane = 0; lane < kWidth<T>; ++lane) {
        const ModeTable* table = b.table[lane];
        low[lane] = high[lane] = kNone;
        if (table == nullptr || mode >= table->modes) continue;
        const int of = table->planes == 1 ? 0 : plane;
        low[lane] = table->Row(of, level[lane], mode);
        high[lane] = table->Row(of, next[lane], mode);
      }
      ModeRows<T>& rows = b.rows[plane][mode];
      LoadRow(low, ModeTable::kRowSize / 4, rows.low);
      LoadRow(high, ModeTable::kRowSize / 4, rows.rise);
      for (int i = 0; i < ModeTable::kRowSize; ++i) rows.rise[i] = rows.rise[i] - rows.low[i];
      rows.of_inertia = LargestColumn(rows, ModeTable::kMomentAt);
      for (int cause = 0; cause < kLiftCauses; ++cause)
        rows.of_lift[cause] = LargestColumn(rows, ModeTable::LiftColumn(cause, kSectionEffects));
    }
  }
}

/// Sets the values that depend on the lane's propellant. Columns that a step needs once are looked up where
/// they are needed.
template <class T>
DISPERSA_INLINE void ShapesAt(StackBending<T>& b, T propellant_kg) {
  if (Any(!((propellant_kg < b.from_kg) & (propellant_kg >= b.to_kg)))) ReadLevels(b, propellant_kg);
  b.within = Clamp((b.level_kg - propellant_kg) / b.span_kg, T(0.0), T(1.0));
  for (int plane = 0; plane < b.planes; ++plane) {
    for (int mode = 0; mode < b.modes; ++mode) {
      const auto at = [&](int column) __attribute__((always_inline)) {
        return b.ColumnAt(plane, mode, column);
      };
      ModeNow<T>& m = b.now[plane][mode];
      const T tabulated = at(ModeTable::kFrequency);
      const auto flies = tabulated > T(0.0);
      const T frequency = Select(flies, tabulated * b.frequency_factor.data()[mode], T(1.0));
      m.stiffness_1_s2 = frequency * frequency;
      const T damping_ratio = at(ModeTable::kDamping) * b.damping_factor;
      m.decay_1_s = damping_ratio * frequency;
      m.damping_1_s = T(2.0) * m.decay_1_s;
      m.damped_frequency_rad_s = frequency * Sqrt(Fma(-damping_ratio, damping_ratio, T(1.0)));
      m.inverse_mass_1_kg = at(ModeTable::kInverseMass);
    }
  }
}

/// Displacement (m), rotation (rad) and rotation rate (rad/s) of a place of the bent body.
template <class T>
struct Bent {
  T y_m, z_m;
  T about_y_rad, about_z_rad;
};
/// A place where forces act: its columns in the table. Residual and the beam that it relieves: 0 for none.
struct ForcePlace {
  int deflection, slope, residual, relieved;
};
/// Of the stage's nozzles.
inline constexpr ForcePlace kAtPivot{ModeTable::kPivotDeflection, ModeTable::kPivotSlope,
                                     ModeTable::kResidual, 0};
/// Of the boosters' rigid link, at the station of their nozzles. Their force along the axis relieves the beam
/// behind the link.
inline constexpr ForcePlace kAtBoosters{ModeTable::kBoosterDeflection, ModeTable::kBoosterSlope, 0,
                                        ModeTable::kBehindBoosters};
/// The shapes of the modes there.
template <class T>
struct PlaceShapes {
  OfPlanes<T> deflection[kModes], slope_1_m[kModes];
};
template <class T>
DISPERSA_INLINE PlaceShapes<T> ShapesOf(const StackBending<T>& b, const ForcePlace& place) {
  PlaceShapes<T> o;
  for (int mode = 0; mode < b.modes; ++mode) {
    o.deflection[mode] = b.ColumnsAt(mode, place.deflection);
    o.slope_1_m[mode] = b.ColumnsAt(mode, place.slope);
  }
  return o;
}
/// How the modes move and turn the place. `force_n` and `couple_n_m` act there. The modes that do not fly
/// answer them at once (residual flexibility: R. H. MacNeal, A hybrid method of component mode synthesis,
/// Computers & Structures 1, 1971).
template <class T>
DISPERSA_INLINE Bent<T> BentAt(const StackBending<T>& b, const BendingState<T>& s, const ForcePlace& place,
                               const PlaceShapes<T>& shapes, const Vector<T>& force_n,
                               const Vector<T>& couple_n_m) {
  Bent<T> o{T(0.0), T(0.0), T(0.0), T(0.0)};
  if (place.residual != 0) {
    const OfPlanes<T> moved = b.ColumnsAt(0, place.residual), both = b.ColumnsAt(0, place.residual + 1),
                      turned = b.ColumnsAt(0, place.residual + 2);
    o = {Fma(moved.y, force_n.y, -(both.y * couple_n_m.z)), Fma(moved.z, force_n.z, both.z * couple_n_m.y),
         Fma(both.z, force_n.z, turned.z * couple_n_m.y), Fma(-both.y, force_n.y, turned.y * couple_n_m.z)};
  }
  for (int mode = 0; mode < b.modes; ++mode) {
    const T q_y = s.q_m[0][mode], q_z = s.q_m[1][mode];
    o.y_m = Fma(shapes.deflection[mode].y, q_y, o.y_m);
    o.z_m = Fma(shapes.deflection[mode].z, q_z, o.z_m);
    o.about_z_rad = Fma(-shapes.slope_1_m[mode].y, q_y, o.about_z_rad);
    o.about_y_rad = Fma(shapes.slope_1_m[mode].z, q_z, o.about_y_rad);
  }
  return o;
}
/// How far the inertial unit is turned against the mean axes, rad about x, y, z.
template <class T>
DISPERSA_INLINE Vector<T> UnitTurn(const StackBending<T>& b, const BendingState<T>& s) {
  Vector<T> turn = Zero<T>();
  for (int mode = 0; mode < b.modes; ++mode) {
    turn.y = Fma(b.UnitSlope(1, mode), s.q_m[1][mode], turn.y);
    turn.z = Fma(-b.UnitSlope(0, mode), s.q_m[0][mode], turn.z);
  }
  return turn;
}
/// Rotation rate of the inertial unit against the mean axes, rad/s. With `gyro` from 0 on: of that gyro.
template <class T>
DISPERSA_INLINE Vector<T> TurnRate(const StackBending<T>& b, const BendingState<T>& s, int gyro) {
  Vector<T> rate = Zero<T>();
  for (int mode = 0; mode < b.modes; ++mode) {
    const T y = gyro < 0 ? b.UnitSlope(0, mode) : b.GyroSlope(0, mode, gyro);
    const T z = gyro < 0 ? b.UnitSlope(1, mode) : b.GyroSlope(1, mode, gyro);
    rate.y = Fma(z, s.rate_m_s[1][mode], rate.y);
    rate.z = Fma(-y, s.rate_m_s[0][mode], rate.z);
  }
  return rate;
}

/// Adds a force and a couple at a place to the modes' generalised forces.
template <class T>
DISPERSA_INLINE void DriveAt(const StackBending<T>& b, const BendingState<T>& s, const ForcePlace& place,
                             const PlaceShapes<T>& shapes, const Vector<T>& force_n,
                             const Vector<T>& couple_n_m, ModalForce<T>& o) {
  for (int mode = 0; mode < b.modes; ++mode) {
    T& of_y = o.drive_m_s2[0][mode];
    T& of_z = o.drive_m_s2[1][mode];
    if (place.relieved != 0) {
      T behind_y(0.0), behind_z(0.0);
      for (int other = 0; other < b.modes; ++other) {
        const OfPlanes<T> behind = b.ColumnsAt(mode, place.relieved + other);
        behind_y = Fma(behind.y, s.q_m[0][other], behind_y);
        behind_z = Fma(behind.z, s.q_m[1][other], behind_z);
      }
      of_y = Fma(-force_n.x, behind_y, of_y);
      of_z = Fma(-force_n.x, behind_z, of_z);
    }
    of_y = Fma(force_n.y, shapes.deflection[mode].y, Fma(-couple_n_m.z, shapes.slope_1_m[mode].y, of_y));
    of_z = Fma(force_n.z, shapes.deflection[mode].z, Fma(couple_n_m.y, shapes.slope_1_m[mode].z, of_z));
  }
}

/// The lift due to bending. Each place of the body has its own incidence: the body's plus slope q +
/// deflection q' / V in the mode's plane. The normal force is distributed along the body
/// (lift_distribution.h). The part due to bending uses the slope of the normal force coefficient at the
/// body's incidence. The effect of a mode's lift is `by_slope` q + `by_rate` q' / V, times the normal force
/// per radian.
template <class T>
struct LiftNow {
  T by_slope, by_rate;
};
/// `aft_m`: of the centre of pressure behind that of slender-body theory.
template <class T>
DISPERSA_INLINE LiftNow<T> LiftOf(const StackBending<T>& b, int plane, int mode, int effect, T aft_m) {
  const auto by = [&](LiftCause cause) __attribute__((always_inline)) {
    return b.ColumnAt(plane, mode, ModeTable::LiftColumn(cause, effect));
  };
  return {Fma(aft_m, by(kSlopeShift), by(kSlopeSlender)), Fma(aft_m, by(kRateShift), by(kRateSlender))};
}
/// Where the air of both planes presses, and whether modes and air are the same in both.
template <class T>
struct LiftPlanes {
  OfPlanes<T> aft_m;
  bool are_one;
};
/// `side`: of the yaw plane (null: as the pitch plane).
template <class T>
DISPERSA_INLINE LiftPlanes<T> LiftPlanesOf(const StackBending<T>& b, const Sections<T>& body,
                                           const NormalForce<T>& air, const SideForce<T>* side) {
  const T aft_m = air.xcp_station_m - body.slender_station_m;
  if (side == nullptr) return {{aft_m, aft_m}, b.planes == 1};
  return {{side->xcp_station_m - body.slender_station_m, aft_m}, false};
}
/// The effects of a mode's motion in both planes: `slope_n` and `rate_n` are the normal forces per radian
/// times q and q' / V.
template <class T>
DISPERSA_INLINE void AddLift(const StackBending<T>& b, int mode, int effect, const LiftPlanes<T>& planes,
                             const OfPlanes<T>& slope_n, const OfPlanes<T>& rate_n, T& y, T& z) {
  const LiftNow<T> of_y = LiftOf(b, 0, mode, effect, planes.aft_m.y);
  const LiftNow<T> of_z = planes.are_one ? of_y : LiftOf(b, 1, mode, effect, planes.aft_m.z);
  y = Fma(slope_n.y, of_y.by_slope, Fma(rate_n.y, of_y.by_rate, y));
  z = Fma(slope_n.z, of_z.by_slope, Fma(rate_n.z, of_z.by_rate, z));
}

/// The additional effects of the flow on a body that bends. Added to the body's force, to its moment about C,
/// and to the modes. `side`: of the yaw plane (null: as the pitch plane).
template <class T>
DISPERSA_INLINE void BendFlow(const StackBending<T>& b, const BendingState<T>& s, const Sections<T>& body,
                              T cg_station_m, const SideForce<T>* side, FlowForce<T>& flow,
                              ModalForce<T>& o) {
  const NormalForce<T>& air = flow.normal;
  const LiftPlanes<T> planes = LiftPlanesOf(b, body, air, side);
  const T side_n = side ? side->normal_n : air.normal_n, side_slope_n = side ? side->slope_n : air.slope_n;
  const T straight_n[kPlanes] = {-(side_n * air.across_y), -(air.normal_n * air.across_z)};
  const T by_rate_n = -(air.slope_n / Max(air.airspeed_m_s, T(1e-30)));
  const T side_by_rate_n = side ? -(side_slope_n / Max(air.airspeed_m_s, T(1e-30))) : by_rate_n;
  T force_n[kPlanes] = {T(0.0), T(0.0)}, first_n_m[kPlanes] = {T(0.0), T(0.0)};
  T *const of_y = o.drive_m_s2[0], *const of_z = o.drive_m_s2[1];
  for (int mode = 0; mode < b.modes; ++mode) {
    const OfPlanes<T> slope_n{-(side_slope_n * s.q_m[0][mode]), -(air.slope_n * s.q_m[1][mode])};
    const OfPlanes<T> rate_n{side_by_rate_n * s.rate_m_s[0][mode], by_rate_n * s.rate_m_s[1][mode]};
    AddLift(b, mode, kForceEffect, planes, slope_n, rate_n, force_n[0], force_n[1]);
    AddLift(b, mode, kFirstEffect, planes, slope_n, rate_n, first_n_m[0], first_n_m[1]);
    for (int other = 0; other < b.modes; ++other)
      AddLift(b, mode, kWorkEffects + other, planes, slope_n, rate_n, of_y[other], of_z[other]);
    const OfPlanes<T> slender = b.ColumnsAt(mode, ModeTable::kStraightLift);
    const OfPlanes<T> shift = b.ColumnsAt(mode, ModeTable::kStraightLift + 1);
    of_y[mode] = Fma(straight_n[0], Fma(planes.aft_m.y, shift.y, slender.y), of_y[mode]);
    of_z[mode] = Fma(straight_n[1], Fma(planes.aft_m.z, shift.z, slender.z), of_z[mode]);
  }
  flow.force_n.y = flow.force_n.y + force_n[0];
  flow.force_n.z = flow.force_n.z + force_n[1];
  flow.moment_n_m.y = flow.moment_n_m.y + Fma(-cg_station_m, force_n[1], first_n_m[1]);
  flow.moment_n_m.z = flow.moment_n_m.z - Fma(-cg_station_m, force_n[0], first_n_m[0]);
}

/// What bending adds to the sections' moments. `drive` is Q / m, `side` as in BendFlow.
template <class T>
class BendingLoads {
 public:
  DISPERSA_INLINE BendingLoads(const StackBending<T>& b, const BendingState<T>& s, const ModalForce<T>& drive,
                               const Sections<T>& body, const NormalForce<T>& air, const SideForce<T>* side)
      : bending_(b), planes_(LiftPlanesOf(b, body, air, side)) {
    const T side_slope_n = side ? side->slope_n : air.slope_n;
    const T airspeed_m_s = Max(air.airspeed_m_s, T(1e-30));
    const T by_rate_n = air.slope_n / airspeed_m_s,
            side_by_rate_n = side ? side_slope_n / airspeed_m_s : by_rate_n;
    for (int mode = 0; mode < b.modes; ++mode) {
      const auto acceleration = [&](int plane) __attribute__((always_inline)) {
        const ModeNow<T>& m = b.At(plane, mode);
        return drive.drive_m_s2[plane][mode] -
               Fma(m.damping_1_s, s.rate_m_s[plane][mode], m.stiffness_1_s2 * s.q_m[plane][mode]);
      };
      moved_[mode] = {acceleration(0), acceleration(1)};
      slope_n_[mode] = {side_slope_n * s.q_m[0][mode], air.slope_n * s.q_m[1][mode]};
      rate_n_[mode] = {side_by_rate_n * s.rate_m_s[0][mode], by_rate_n * s.rate_m_s[1][mode]};
    }
  }
  /// Adds to the moments of a load station.
  DISPERSA_INLINE void AddAt(int station, T& y_n_m, T& z_n_m) const {
    for (int mode = 0; mode < bending_.modes; ++mode) {
      AddLift(bending_, mode, kSectionEffects + station, planes_, slope_n_[mode], rate_n_[mode], y_n_m,
              z_n_m);
      const OfPlanes<T> inertia = bending_.ColumnsAt(mode, ModeTable::kMomentAt + station);
      y_n_m = Fma(moved_[mode].y, inertia.y, y_n_m);
      z_n_m = Fma(moved_[mode].z, inertia.z, z_n_m);
    }
  }
  /// It adds no more than this at any station.
  DISPERSA_INLINE T Most() const {
    T y_n_m(0.0), z_n_m(0.0);
    for (int mode = 0; mode < bending_.modes; ++mode) {
      y_n_m = y_n_m + MostOf(0, mode, moved_[mode].y, slope_n_[mode].y, rate_n_[mode].y, planes_.aft_m.y);
      z_n_m = z_n_m + MostOf(1, mode, moved_[mode].z, slope_n_[mode].z, rate_n_[mode].z, planes_.aft_m.z);
    }
    return Sqrt(Fma(y_n_m, y_n_m, z_n_m * z_n_m));
  }

 private:
  DISPERSA_INLINE T MostOf(int plane, int mode, T moved, T slope_n, T rate_n, T aft_m) const {
    const ModeRows<T>& rows = bending_.rows[bending_.planes == 1 ? 0 : plane][mode];
    const auto now = [this](const typename ModeRows<T>::Largest& of) __attribute__((always_inline)) {
      return Fma(bending_.within, of.rise, of.low);
    };
    const T aft = Abs(aft_m);
    const T by_slope = Fma(aft, now(rows.of_lift[kSlopeShift]), now(rows.of_lift[kSlopeSlender]));
    const T by_rate = Fma(aft, now(rows.of_lift[kRateShift]), now(rows.of_lift[kRateSlender]));
    return Fma(Abs(moved), now(rows.of_inertia), Fma(Abs(slope_n), by_slope, Abs(rate_n) * by_rate));
  }

  const StackBending<T>& bending_;
  LiftPlanes<T> planes_;
  OfPlanes<T> moved_[kModes], slope_n_[kModes], rate_n_[kModes];
};

/// Ends the sum of generalised forces: compression by the force along the axis, over the masses.
template <class T>
DISPERSA_INLINE void FinishDrive(const StackBending<T>& b, const BendingState<T>& s, T axial_n,
                                 ModalForce<T>& o) {
  for (int mode = 0; mode < b.modes; ++mode) {
    T shortened_y(0.0), shortened_z(0.0);
    for (int other = 0; other < b.modes; ++other) {
      const OfPlanes<T> with = b.ColumnsAt(mode, ModeTable::kShortening + other);
      shortened_y = Fma(with.y, s.q_m[0][other], shortened_y);
      shortened_z = Fma(with.z, s.q_m[1][other], shortened_z);
    }
    T &of_y = o.drive_m_s2[0][mode], &of_z = o.drive_m_s2[1][mode];
    of_y = b.At(0, mode).inverse_mass_1_kg * Fma(axial_n, shortened_y, of_y);
    of_z = b.At(1, mode).inverse_mass_1_kg * Fma(axial_n, shortened_z, of_z);
  }
}

/// A time over which every mode swings freely, exactly.
template <class T>
struct Swing {
  T time_s;
  T softness_s2[kPlanes][kModes], damping_1_s[kPlanes][kModes];  ///< softness: 1 / omega²
  T aa[kPlanes][kModes], ar[kPlanes][kModes], ra[kPlanes][kModes], rr[kPlanes][kModes];
};
template <class T>
DISPERSA_INLINE Swing<T> SwingOver(const StackBending<T>& b, T time_s) {
  Swing<T> o;
  o.time_s = time_s;
  for (int plane = 0; plane < b.planes; ++plane)
    for (int mode = 0; mode < b.modes; ++mode) {
      const ModeNow<T>& m = b.now[plane][mode];
      o.softness_s2[plane][mode] = T(1.0) / m.stiffness_1_s2;
      o.damping_1_s[plane][mode] = m.damping_1_s;
      const T e = Exp(-(m.decay_1_s * time_s)), angle = m.damped_frequency_rad_s * time_s;
      const T cosine = e * Cos(angle), sine = e * Sin(angle) / m.damped_frequency_rad_s;
      o.aa[plane][mode] = Fma(m.decay_1_s, sine, cosine);
      o.ar[plane][mode] = sine;
      o.ra[plane][mode] = -(m.stiffness_1_s2 * sine);
      o.rr[plane][mode] = Fma(-m.decay_1_s, sine, cosine);
    }
  return o;
}
/// Twice the time.
template <class T>
DISPERSA_INLINE Swing<T> Twice(const StackBending<T>& b, const Swing<T>& s) {
  Swing<T> o = s;
  o.time_s = s.time_s + s.time_s;
  for (int plane = 0; plane < b.planes; ++plane)
    for (int mode = 0; mode < b.modes; ++mode) {
      const T aa = s.aa[plane][mode], ar = s.ar[plane][mode], ra = s.ra[plane][mode], rr = s.rr[plane][mode];
      o.aa[plane][mode] = Fma(aa, aa, ar * ra);
      o.ar[plane][mode] = Fma(aa, ar, ar * rr);
      o.ra[plane][mode] = Fma(ra, aa, rr * ra);
      o.rr[plane][mode] = Fma(ra, ar, rr * rr);
    }
  return o;
}

/// The modes after the time of `swing` under drives d0 + d1 t + d2 t², exactly: a particular motion a + b t +
/// c t² plus the free motion of the rest.
template <class T>
DISPERSA_INLINE BendingState<T> Swung(const StackBending<T>& b, const Swing<T>& swing,
                                      const BendingState<T>& from, const ModalForce<T>& d0,
                                      const ModalForce<T>& d1, const ModalForce<T>& d2) {
  BendingState<T> to = from;
  const T t = swing.time_s, two(2.0);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (int mode = 0; mode < b.modes; ++mode) {
      const int of = b.planes == 1 ? 0 : plane;
      const T softness = swing.softness_s2[of][mode], damping = swing.damping_1_s[of][mode];
      const T c = d2.drive_m_s2[plane][mode] * softness;
      const T v = Fma(-(two * damping), c, d1.drive_m_s2[plane][mode]) * softness;
      const T a = Fma(-damping, v, Fma(-two, c, d0.drive_m_s2[plane][mode])) * softness;
      const T q = from.q_m[plane][mode] - a, rate = from.rate_m_s[plane][mode] - v;
      to.q_m[plane][mode] =
          Fma(swing.aa[of][mode], q, Fma(swing.ar[of][mode], rate, Fma(t, Fma(t, c, v), a)));
      to.rate_m_s[plane][mode] =
          Fma(swing.ra[of][mode], q, Fma(swing.rr[of][mode], rate, Fma(two * t, c, v)));
    }
  return to;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
