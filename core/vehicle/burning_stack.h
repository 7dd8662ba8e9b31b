// Masses and the burn of W stacks side by side (core/math/lanes.h). mass.h and propulsion.h use the same code
// for one stack.
#pragma once

#include "core/math/constants.h"
#include "core/math/lane_vector.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// DrainingMass of each lane.
template <class T>
struct DrainingMassLanes {
  T first_per_kg_m, first_per_kg2_m, second_per_kg_m2, second_per_kg2_m2, second_per_kg3_m2;
  T first_kg_m, second_kg_m2;
  bool any_mixes;  ///< any lane has a mixture that is not its tanks'
};
template <class T>
DISPERSA_INLINE void SetLane(DrainingMassLanes<T>& t, int lane, const DrainingMass& tanks) {
  Lane(t.first_per_kg_m, lane) = tanks.first_per_kg_m;
  Lane(t.first_per_kg2_m, lane) = tanks.first_per_kg2_m;
  Lane(t.second_per_kg_m2, lane) = tanks.second_per_kg_m2;
  Lane(t.second_per_kg2_m2, lane) = tanks.second_per_kg2_m2;
  Lane(t.second_per_kg3_m2, lane) = tanks.second_per_kg3_m2;
  Lane(t.first_kg_m, lane) = tanks.first_kg_m;
  Lane(t.second_kg_m2, lane) = tanks.second_kg_m2;
  t.any_mixes = false;
  for (int i = 0; i < kWidth<T>; ++i) t.any_mixes |= Lane(t.second_kg_m2, i) != 0.0;
}
/// Where the kilogram is that leaves next: the slope of the first moment over the mass.
template <class T>
DISPERSA_INLINE T SurfaceOf(const DrainingMassLanes<T>& t, T kg) {
  return Fma(T(2.0) * kg, t.first_per_kg2_m, t.first_per_kg_m);
}
/// Its second moment: the slope of the second moment over the mass.
template <class T>
DISPERSA_INLINE T SecondPerKgOf(const DrainingMassLanes<T>& t, T kg) {
  return Fma(kg, Fma(T(3.0) * kg, t.second_per_kg3_m2, T(2.0) * t.second_per_kg2_m2), t.second_per_kg_m2);
}

/// StackMass, prepared.
template <class T>
struct StackMassLanes {
  T fixed_mass_kg, first_moment_kg_m, second_moment_kg_m2, fixed_axial_kg_m2;
  T grain_station_m;
  T outer2_m2;        ///< the grain's outer radius squared
  T inner_per_kg_m2;  ///< by which each kilogram lowers the bore's radius squared
  T length2_m2;       ///< the grain's length squared, over 12
  bool any_drains;    ///< any lane has tanks or a table in place of the grain:
  T drains;           ///< 1 for liquid stages (DrainingMass), 2 for tables (MassRows), 0 for grains
  DrainingMassLanes<T> tanks;
  bool any_tables;
  const MassRows* table[kWidth<T>];  ///< null: none
};
template <class T>
DISPERSA_INLINE void SetLane(StackMassLanes<T>& s, int lane, const StackMass& mass) {
  Lane(s.fixed_mass_kg, lane) = mass.fixed_mass_kg;
  Lane(s.first_moment_kg_m, lane) = mass.fixed_first_moment_kg_m;
  Lane(s.second_moment_kg_m2, lane) = mass.fixed_second_moment_kg_m2;
  Lane(s.fixed_axial_kg_m2, lane) = mass.fixed_axial_inertia_kg_m2;
  Lane(s.grain_station_m, lane) = mass.grain_station_m;
  Lane(s.outer2_m2, lane) = mass.grain_outer_radius_m * mass.grain_outer_radius_m;
  Lane(s.inner_per_kg_m2, lane) = mass.drains || mass.table != nullptr
                                      ? 0.0
                                      : 1.0 / (kPi * mass.grain_density_kg_m3 * mass.grain_length_m);
  Lane(s.length2_m2, lane) = mass.grain_length_m * mass.grain_length_m / 12.0;
  s.table[lane] = mass.table;
  Lane(s.drains, lane) = s.table[lane] != nullptr ? 2.0 : mass.drains ? 1.0 : 0.0;
  SetLane(s.tanks, lane, mass.tanks);
  s.any_drains = s.any_tables = false;
  for (int i = 0; i < kWidth<T>; ++i) {
    s.any_drains |= Lane(s.drains, i) > 0.0;
    s.any_tables |= s.table[i] != nullptr;
  }
}

/// The row of a table that a mass of propellant falls into.
alignas(32) inline constexpr double kNoMassRow[MassRows::kSideRowSize] = {};
DISPERSA_INLINE int MassPieceAt(const MassRows& table, double propellant_kg) {
  const double* begin_kg = table.begin_kg.data();
  int low = 0, high = static_cast<int>(table.begin_kg.size());
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (propellant_kg < begin_kg[middle] ? high : low) = middle;
  }
  return low;
}
DISPERSA_INLINE const double* MassRowAt(const MassRows* table, double propellant_kg) {
  if (table == nullptr) return kNoMassRow;
  return table->rows.data() + MassRows::kRowSize * MassPieceAt(*table, propellant_kg);
}

/// Sums over masses off the axis (SideSums) of each lane's stack, prepared.
template <class T>
struct SideMassLanes {
  T fixed[kSideSums];                ///< of all but the burning propellant
  const MassRows* table[kWidth<T>];  ///< null: none has side rows
};
template <class T>
DISPERSA_INLINE void SetLane(SideMassLanes<T>& s, int lane, const StackMass& mass) {
  const double* const sums = mass.sides.data();
  for (int k = 0; k < kSideSums; ++k) Lane(s.fixed[k], lane) = sums[k];
  s.table[lane] = mass.table != nullptr && mass.table->side_rows.size() > 0 ? mass.table : nullptr;
}
template <class T>
DISPERSA_INLINE void SidesAt(const SideMassLanes<T>& s, T propellant_kg, T* sums) {
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

/// MassProperties of StackMass::At.
template <class T>
struct MassPropertiesLanes {
  T mass_kg, cg_station_m, axial_kg_m2, transverse_kg_m2, axial_per_kg_m2, transverse_per_kg_m2;
  T source_station_m;  ///< where mass goes: the grain's middle, or the surfaces of the liquids, by their
                       ///< shares
};
template <class T>
DISPERSA_INLINE MassPropertiesLanes<T> MassesAt(const StackMassLanes<T>& s, T propellant_kg) {
  MassPropertiesLanes<T> m;
  m.mass_kg = s.fixed_mass_kg + propellant_kg;
  const T cg = Fma(propellant_kg, s.grain_station_m, s.first_moment_kg_m) / m.mass_kg;
  const T inner2 = Fma(-propellant_kg, s.inner_per_kg_m2, s.outer2_m2);
  const T grain_axial = T(0.5) * propellant_kg * (s.outer2_m2 + inner2);
  const T about_nose = Fma(s.grain_station_m, s.grain_station_m, s.length2_m2);
  m.cg_station_m = cg;
  m.axial_kg_m2 = s.fixed_axial_kg_m2 + grain_axial;
  m.transverse_kg_m2 =
      s.second_moment_kg_m2 + Fma(T(0.5), grain_axial, propellant_kg * about_nose) - m.mass_kg * cg * cg;
  // d(grain_axial)/dm = r_i², because the propellant goes at the bore.
  m.axial_per_kg_m2 = inner2;
  m.transverse_per_kg_m2 = Fma(T(0.5), inner2, s.length2_m2) + Square(s.grain_station_m - cg);
  m.source_station_m = s.grain_station_m;
  if (s.any_drains) {
    const auto drains = s.drains > T(0.0);
    const DrainingMassLanes<T>& t = s.tanks;
    const T p = propellant_kg;
    T first = Fma(p, Fma(p, t.first_per_kg2_m, t.first_per_kg_m), s.first_moment_kg_m);
    T surface = SurfaceOf(t, p);
    T second = Fma(p, Fma(p, Fma(p, t.second_per_kg3_m2, t.second_per_kg2_m2), t.second_per_kg_m2),
                   s.second_moment_kg_m2);
    T second_per_kg = SecondPerKgOf(t, p);
    T axial = s.fixed_axial_kg_m2, axial_per_kg(0.0);
    if (s.any_tables) {
      const double* piece[kWidth<T>];
      for (int lane = 0; lane < kWidth<T>; ++lane) piece[lane] = MassRowAt(s.table[lane], Lane(p, lane));
      T row[MassRows::kRowSize];
      LoadRow(piece, MassRows::kRowSize / 4, row);
      const auto tabled = s.drains > T(1.0);
      const T from = p - row[0];
      first = Select(tabled, s.first_moment_kg_m + Fma(from, row[2], row[1]), first);
      surface = Select(tabled, row[2], surface);
      second = Select(tabled, s.second_moment_kg_m2 + Fma(from, row[4], row[3]), second);
      second_per_kg = Select(tabled, row[4], second_per_kg);
      axial = Select(tabled, axial + Fma(from, row[6], row[5]), axial);
      axial_per_kg = Select(tabled, row[6], axial_per_kg);
    }
    const T at = first / m.mass_kg;
    m.cg_station_m = Select(drains, at, m.cg_station_m);
    m.axial_kg_m2 = Select(drains, axial, m.axial_kg_m2);
    m.transverse_kg_m2 = Select(drains, second - m.mass_kg * at * at, m.transverse_kg_m2);
    m.axial_per_kg_m2 = Select(drains, axial_per_kg, m.axial_per_kg_m2);
    // About C, which moves by (surface - C) / m for each kilogram.
    m.transverse_per_kg_m2 =
        Select(drains, Fma(at, at, second_per_kg) - T(2.0) * at * surface, m.transverse_per_kg_m2);
    m.source_station_m = Select(drains, surface, m.source_station_m);
  }
  return m;
}

/// MotorBurn, prepared. Times count from ignition. A ramp without duration has slope 0 and base 1.
template <class T>
struct MotorBurnLanes {
  T vacuum_thrust_n, full_flow_kg_s, propellant_kg, duration_s, exit_area_m2;
  T rise_s, rise_slope_1_s, rise_base, tail_s, tail_slope_1_s, tail_base;
  T left_kg;                      ///< that stays when the burn has ended
  T curve_rate, curve_flow_kg_s;  ///< of the curve's own time (0: no curve)
  const BurnCurve* curve[kWidth<T>];
  bool has_curves;  ///< of any lane
};
/// Row for a lane without a curve.
alignas(32) inline constexpr double kNoPiece[BurnCurve::kRowSize] = {};
template <class T>
DISPERSA_INLINE void SetLane(MotorBurnLanes<T>& b, int lane, const MotorBurn& burn) {
  Lane(b.vacuum_thrust_n, lane) = burn.vacuum_thrust_n;
  Lane(b.full_flow_kg_s, lane) = burn.full_flow_kg_s;
  Lane(b.propellant_kg, lane) = burn.propellant_mass_kg;
  Lane(b.duration_s, lane) = burn.duration_s;
  Lane(b.exit_area_m2, lane) = burn.exit_area_m2;
  Lane(b.rise_s, lane) = burn.rise_s;
  Lane(b.rise_slope_1_s, lane) = burn.rise_s > 0.0 ? 1.0 / burn.rise_s : 0.0;
  Lane(b.rise_base, lane) = burn.rise_s > 0.0 ? 0.0 : 1.0;
  Lane(b.tail_s, lane) = burn.tail_s;
  Lane(b.tail_slope_1_s, lane) = burn.tail_s > 0.0 ? 1.0 / burn.tail_s : 0.0;
  Lane(b.tail_base, lane) = burn.tail_s > 0.0 ? 0.0 : 1.0;
  Lane(b.left_kg, lane) = burn.left_kg;
  b.curve[lane] = burn.curve.get();
  Lane(b.curve_rate, lane) = b.curve[lane] ? burn.curve_rate : 0.0;
  Lane(b.curve_flow_kg_s, lane) = b.curve[lane] ? burn.full_flow_kg_s / burn.curve_rate : 0.0;
  b.has_curves = false;
  for (int i = 0; i < kWidth<T>; ++i) b.has_curves |= b.curve[i] != nullptr;
}

/// The piece of a curve that a time of the curve falls into.
DISPERSA_INLINE const double* PieceAt(const BurnCurve* curve, double time_s) {
  if (curve == nullptr) return kNoPiece;
  const double* begin_s = curve->begin_s.data();
  int low = 0, high = static_cast<int>(curve->begin_s.size());
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (time_s < begin_s[middle] ? high : low) = middle;
  }
  return curve->rows.data() + BurnCurve::kRowSize * low;
}

/// Fractions of full thrust and of full flow, and propellant left, at a time within the burn.
template <class T>
struct BurnState {
  T fraction, flow_fraction, propellant_kg;
};
template <class T>
DISPERSA_INLINE BurnState<T> BurnAt(const MotorBurnLanes<T>& b, T since_ignition_s) {
  const T since = Clamp(since_ignition_s, T(0.0), b.duration_s);
  const T left = b.duration_s - since;
  // Burnt at full flow from the end of the rise, plus the rise's triangle.
  const T rising = Min(since, b.rise_s), falling = Max(b.tail_s - left, T(0.0));
  const T full_s = Fma(T(0.5) * rising * rising, b.rise_slope_1_s, since - rising);
  const T lacking_s = T(0.5) * falling * falling * b.tail_slope_1_s;
  BurnState<T> state;
  state.fraction =
      Min(T(1.0), Min(Fma(since, b.rise_slope_1_s, b.rise_base), Fma(left, b.tail_slope_1_s, b.tail_base)));
  state.flow_fraction = state.fraction;
  const T left_kg = b.propellant_kg - b.full_flow_kg_s * (full_s - lacking_s);
  state.propellant_kg = Select(left_kg < T(0.0), T(0.0), left_kg);
  if (b.has_curves) {
    const auto curved = b.curve_rate > T(0.0);
    const T time_s = since * b.curve_rate;
    const double* piece[kWidth<T>];
    for (int lane = 0; lane < kWidth<T>; ++lane) piece[lane] = PieceAt(b.curve[lane], Lane(time_s, lane));
    T row[BurnCurve::kRowSize];
    LoadRow(piece, BurnCurve::kRowSize / 4, row);
    const T from_s = time_s - row[0];
    const T burnt_s = from_s * Fma(T(0.5) * from_s, row[5], row[4]);
    const T curve_kg = Fma(-b.curve_flow_kg_s, burnt_s, b.propellant_kg * row[3]);
    const T level = Max(Fma(from_s, row[2], row[1]), T(0.0));
    const T flow_level = Max(Fma(from_s, row[5], row[4]), T(0.0));
    state.fraction = Select(curved, level, state.fraction);
    state.flow_fraction = Select(curved, flow_level, state.flow_fraction);
    state.propellant_kg = Select(curved, Select(curve_kg < T(0.0), T(0.0), curve_kg), state.propellant_kg);
  }
  return state;
}

/// Liquids of boosters of a mass: the centre of gravity, and the square of the radius of gyration about it,
/// across the axis. The kilogram that leaves next: its place at the surfaces, and the same square.
template <class T>
struct BoosterLiquids {
  T station_m, gyration2_m2, surface_m, surface_gyration2_m2;
};
template <class T>
DISPERSA_INLINE BoosterLiquids<T> LiquidsOf(const DrainingMassLanes<T>& t, T kg) {
  BoosterLiquids<T> o;
  o.station_m = Fma(kg, t.first_per_kg2_m, t.first_per_kg_m);
  T second_m2 = Fma(kg, Fma(kg, t.second_per_kg3_m2, t.second_per_kg2_m2), t.second_per_kg_m2);
  if (t.any_mixes) {
    // None is ever empty where there is something to divide.
    const T per_kg = T(1.0) / Select(kg > T(0.0), kg, T(1.0));
    o.station_m = Fma(t.first_kg_m, per_kg, o.station_m);
    second_m2 = Fma(t.second_kg_m2, per_kg, second_m2);
  }
  o.gyration2_m2 = second_m2 - Square(o.station_m);
  o.surface_m = SurfaceOf(t, kg);
  o.surface_gyration2_m2 = SecondPerKgOf(t, kg) - Square(o.surface_m);
  return o;
}

/// All boosters of the first stage together.
template <class T>
struct BesideStage {
  MotorBurnLanes<T> burn;  ///< left_kg: what they still carry when it has ended
  T station_m, outer2_m2, inner_per_kg_m2, length2_m2, radius2_m2;
  bool drains;  ///< tanks in place of grains: of the vehicle, the same in all lanes
  DrainingMassLanes<T> tanks;
};
template <class T>
DISPERSA_INLINE void SetLane(BesideStage<T>& b, int lane, const MotorBurn& burn,
                             const BoosterPropellant& propellant) {
  SetLane(b.burn, lane, burn);
  Lane(b.station_m, lane) = propellant.station_m;
  Lane(b.outer2_m2, lane) = propellant.outer_radius_m * propellant.outer_radius_m;
  Lane(b.inner_per_kg_m2, lane) =
      propellant.kilograms_per_area_m2 > 0.0 ? 1.0 / propellant.kilograms_per_area_m2 : 0.0;
  Lane(b.length2_m2, lane) = propellant.length_m * propellant.length_m / 12.0;
  Lane(b.radius2_m2, lane) = propellant.radius_m * propellant.radius_m;
  b.drains = propellant.drains;
  SetLane(b.tanks, lane, propellant.tanks);
}

/// Adds tubes of propellant whose axes are off the vehicle's axis by a radius, spread evenly about it.
/// `own_axial_kg_m2`: their moments of inertia about their own axes. `length2_m2`: their length squared, over
/// 12; of liquids, which have none about the axis, their gyration2_m2. By Huygens and Steiner, from both
/// centres to the common one.
template <class T>
DISPERSA_INLINE void AddTubes(T kg, T own_axial_kg_m2, T station_m, T length2_m2, T radius2_m2,
                              MassPropertiesLanes<T>& m) {
  const T apart = kg * radius2_m2;
  const T old_cg = m.cg_station_m, old_kg = m.mass_kg;
  m.mass_kg = old_kg + kg;
  m.cg_station_m = Fma(kg, station_m, old_kg * old_cg) / m.mass_kg;
  m.axial_kg_m2 = m.axial_kg_m2 + own_axial_kg_m2 + apart;
  m.transverse_kg_m2 =
      m.transverse_kg_m2 + old_kg * Square(m.cg_station_m - old_cg) +
      Fma(T(0.5), own_axial_kg_m2 + apart, kg * (length2_m2 + Square(station_m - m.cg_station_m)));
}

/// AddBeside of tanks. A function of its own: few vehicles need it.
template <class T>
DISPERSA_OUT_OF_LINE MassPropertiesLanes<T> WithTanksBeside(const BesideStage<T>& b, T beside_kg,
                                                            T beside_kg_s, T flow_kg_s,
                                                            MassPropertiesLanes<T> m) {
  const T none(0.0), one(1.0), half(0.5);
  const BoosterLiquids<T> liquids = LiquidsOf(b.tanks, beside_kg);
  const T old_cg = m.cg_station_m;
  AddTubes(beside_kg, none, liquids.station_m, liquids.gyration2_m2, b.radius2_m2, m);
  const T total_kg_s = beside_kg_s + flow_kg_s;
  const T share = Select(total_kg_s > none, beside_kg_s / Select(total_kg_s > none, total_kg_s, one), none);
  const T moved = Square(m.source_station_m - m.cg_station_m) - Square(m.source_station_m - old_cg);
  const T beside_transverse =
      Fma(half, b.radius2_m2, liquids.surface_gyration2_m2) + Square(liquids.surface_m - m.cg_station_m);
  m.axial_per_kg_m2 = m.axial_per_kg_m2 + share * (b.radius2_m2 - m.axial_per_kg_m2);
  const T own_transverse = m.transverse_per_kg_m2 + moved;
  m.transverse_per_kg_m2 = own_transverse + share * (beside_transverse - own_transverse);
  m.source_station_m = m.source_station_m + share * (liquids.surface_m - m.source_station_m);
  return m;
}

/// Adds `beside_kg` of the boosters' propellant, of which `beside_kg_s` flows beside the stage's own
/// `flow_kg_s`. Rates by mass and the place that mass comes from become those of both flows together.
template <class T>
DISPERSA_INLINE void AddBeside(const BesideStage<T>& b, T beside_kg, T beside_kg_s, T flow_kg_s,
                               MassPropertiesLanes<T>& m) {
  if (b.drains) {
    m = WithTanksBeside(b, beside_kg, beside_kg_s, flow_kg_s, m);
    return;
  }
  const T inner2 = Fma(-beside_kg, b.inner_per_kg_m2, b.outer2_m2);
  const T old_cg = m.cg_station_m;
  AddTubes(beside_kg, T(0.5) * beside_kg * (b.outer2_m2 + inner2), b.station_m, b.length2_m2, b.radius2_m2,
           m);
  const T total_kg_s = beside_kg_s + flow_kg_s;
  const T none(0.0), one(1.0);
  const T share = Select(total_kg_s > none, beside_kg_s / Select(total_kg_s > none, total_kg_s, one), none);
  // The stage's own rate was about its own centre.
  const T moved = Square(m.source_station_m - m.cg_station_m) - Square(m.source_station_m - old_cg);
  const T beside_axial = inner2 + b.radius2_m2;
  const T beside_transverse = Fma(T(0.5), beside_axial, b.length2_m2) + Square(b.station_m - m.cg_station_m);
  m.axial_per_kg_m2 = m.axial_per_kg_m2 + share * (beside_axial - m.axial_per_kg_m2);
  const T own_transverse = m.transverse_per_kg_m2 + moved;
  m.transverse_per_kg_m2 = own_transverse + share * (beside_transverse - own_transverse);
  m.source_station_m = m.source_station_m + share * (b.station_m - m.source_station_m);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
