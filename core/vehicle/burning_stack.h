// Masses and the burn of W stacks side by side (core/math/lanes.h). mass.h and propulsion.h use the same code
// for one stack.
#pragma once

#include "core/math/constants.h"
#include "core/math/lane_vector.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Where the kilogram is that leaves next: the slope of the first moment over the mass.
template <class T>
DISPERSA_INLINE T SurfaceOf(const DrainingMassOf<T>& t, T kg) {
  return Fma(T(2.0) * kg, t.first_per_kg2_m, t.first_per_kg_m);
}
/// Its second moment: the slope of the second moment over the mass.
template <class T>
DISPERSA_INLINE T SecondPerKgOf(const DrainingMassOf<T>& t, T kg) {
  return Fma(kg, Fma(T(3.0) * kg, t.second_per_kg3_m2, T(2.0) * t.second_per_kg2_m2), t.second_per_kg_m2);
}

/// The stack of each lane as it burns.
template <class T>
struct BurningStack : StackSums<T> {
  bool any_drains;  ///< any lane has tanks or a table in place of the grain:
  T drains;         ///< 1 for liquid stages (DrainingMass), 2 for tables (MassRows), 0 for grains
  bool any_tables;
  const MassRows* table[kWidth<T>];  ///< null: none
};
template <class T>
DISPERSA_INLINE void SetStack(BurningStack<T>& s, int lane, const StackMass& mass) {
  SetLane<StackSums>(s, lane, mass);
  s.table[lane] = mass.table;
  Lane(s.drains, lane) = s.table[lane] != nullptr ? 2.0 : mass.drains ? 1.0 : 0.0;
  s.any_drains = IsAnywhere(s.drains);
  s.any_tables = false;
  for (const MassRows* const table : s.table) s.any_tables |= table != nullptr;
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

/// StackMass::At.
template <class T>
DISPERSA_INLINE MassPropertiesOf<T> MassesAt(const BurningStack<T>& s, T propellant_kg) {
  MassPropertiesOf<T> m;
  m.mass_kg = s.fixed_mass_kg + propellant_kg;
  const T cg = Fma(propellant_kg, s.grain_station_m, s.fixed_first_moment_kg_m) / m.mass_kg;
  const T inner2 = Fma(-propellant_kg, s.grain_inner_per_kg_m2, s.grain_outer2_m2);
  const T grain_axial = T(0.5) * propellant_kg * (s.grain_outer2_m2 + inner2);
  const T about_nose = Fma(s.grain_station_m, s.grain_station_m, s.grain_length2_m2);
  m.cg_station_m = cg;
  m.axial_inertia_kg_m2 = s.fixed_axial_inertia_kg_m2 + grain_axial;
  m.transverse_inertia_kg_m2 = s.fixed_second_moment_kg_m2 +
                               Fma(T(0.5), grain_axial, propellant_kg * about_nose) - m.mass_kg * cg * cg;
  // d(grain_axial)/dm = r_i², because the propellant goes at the bore.
  m.axial_inertia_per_kg = inner2;
  m.transverse_inertia_per_kg = Fma(T(0.5), inner2, s.grain_length2_m2) + Square(s.grain_station_m - cg);
  m.source_station_m = s.grain_station_m;
  if (s.any_drains) {
    const auto drains = s.drains > T(0.0);
    const DrainingMassOf<T>& t = s.tanks;
    const T p = propellant_kg;
    T first = Fma(p, Fma(p, t.first_per_kg2_m, t.first_per_kg_m), s.fixed_first_moment_kg_m);
    T surface = SurfaceOf(t, p);
    T second = Fma(p, Fma(p, Fma(p, t.second_per_kg3_m2, t.second_per_kg2_m2), t.second_per_kg_m2),
                   s.fixed_second_moment_kg_m2);
    T second_per_kg = SecondPerKgOf(t, p);
    T axial = s.fixed_axial_inertia_kg_m2, axial_per_kg(0.0);
    if (s.any_tables) {
      const double* piece[kWidth<T>];
      for (int lane = 0; lane < kWidth<T>; ++lane) piece[lane] = MassRowAt(s.table[lane], Lane(p, lane));
      T row[MassRows::kRowSize];
      LoadRow(piece, MassRows::kRowSize / 4, row);
      const auto tabled = s.drains > T(1.0);
      const T from = p - row[0];
      first = Select(tabled, s.fixed_first_moment_kg_m + Fma(from, row[2], row[1]), first);
      surface = Select(tabled, row[2], surface);
      second = Select(tabled, s.fixed_second_moment_kg_m2 + Fma(from, row[4], row[3]), second);
      second_per_kg = Select(tabled, row[4], second_per_kg);
      axial = Select(tabled, axial + Fma(from, row[6], row[5]), axial);
      axial_per_kg = Select(tabled, row[6], axial_per_kg);
    }
    const T at = first / m.mass_kg;
    m.cg_station_m = Select(drains, at, m.cg_station_m);
    m.axial_inertia_kg_m2 = Select(drains, axial, m.axial_inertia_kg_m2);
    m.transverse_inertia_kg_m2 = Select(drains, second - m.mass_kg * at * at, m.transverse_inertia_kg_m2);
    m.axial_inertia_per_kg = Select(drains, axial_per_kg, m.axial_inertia_per_kg);
    // About C, which moves by (surface - C) / m for each kilogram.
    m.transverse_inertia_per_kg =
        Select(drains, Fma(at, at, second_per_kg) - T(2.0) * at * surface, m.transverse_inertia_per_kg);
    m.source_station_m = Select(drains, surface, m.source_station_m);
  }
  return m;
}

/// The burn of each lane. Times count from ignition. A ramp without duration has slope 0 and base 1.
template <class T>
struct BurningMotor : BurnNumbers<T> {
  T rise_slope_1_s, rise_base, tail_slope_1_s, tail_base;
  T curve_flow_kg_s;  ///< of the curve's own time
  const BurnCurve* curve[kWidth<T>];
  bool has_curves;  ///< of any lane
};
/// Row for a lane without a curve.
alignas(32) inline constexpr double kNoPiece[BurnCurve::kRowSize] = {};
template <class T>
DISPERSA_INLINE void SetBurn(BurningMotor<T>& b, int lane, const MotorBurn& burn) {
  SetLane<BurnNumbers>(b, lane, burn);
  Lane(b.rise_slope_1_s, lane) = burn.rise_s > 0.0 ? 1.0 / burn.rise_s : 0.0;
  Lane(b.rise_base, lane) = burn.rise_s > 0.0 ? 0.0 : 1.0;
  Lane(b.tail_slope_1_s, lane) = burn.tail_s > 0.0 ? 1.0 / burn.tail_s : 0.0;
  Lane(b.tail_base, lane) = burn.tail_s > 0.0 ? 0.0 : 1.0;
  b.curve[lane] = burn.curve.get();
  if (b.curve[lane] == nullptr) Lane(b.curve_rate, lane) = 0.0;
  Lane(b.curve_flow_kg_s, lane) = b.curve[lane] ? burn.full_flow_kg_s / burn.curve_rate : 0.0;
  b.has_curves = false;
  for (const BurnCurve* const curve : b.curve) b.has_curves |= curve != nullptr;
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
DISPERSA_INLINE BurnState<T> BurnAt(const BurningMotor<T>& b, T since_ignition_s) {
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
  const T left_kg = b.propellant_mass_kg - b.full_flow_kg_s * (full_s - lacking_s);
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
    const T curve_kg = Fma(-b.curve_flow_kg_s, burnt_s, b.propellant_mass_kg * row[3]);
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
/// `any_mixes`: some lane's mixture is not its tanks'.
template <class T>
struct BoosterLiquids {
  T station_m, gyration2_m2, surface_m, surface_gyration2_m2;
};
template <class T>
DISPERSA_INLINE BoosterLiquids<T> LiquidsOf(const DrainingMassOf<T>& t, bool any_mixes, T kg) {
  BoosterLiquids<T> o;
  o.station_m = Fma(kg, t.first_per_kg2_m, t.first_per_kg_m);
  T second_m2 = Fma(kg, Fma(kg, t.second_per_kg3_m2, t.second_per_kg2_m2), t.second_per_kg_m2);
  if (any_mixes) {
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
  BurningMotor<T> burn;  ///< left_kg: what they still carry when it has ended
  T station_m, outer2_m2, inner_per_kg_m2, length2_m2, radius2_m2;
  bool drains;  ///< tanks in place of grains: of the vehicle, the same in all lanes
  DrainingMassOf<T> tanks;
  bool any_mixes;
};
template <class T>
DISPERSA_INLINE void SetBeside(BesideStage<T>& b, int lane, const MotorBurn& burn,
                               const BoosterPropellant& propellant) {
  SetBurn(b.burn, lane, burn);
  Lane(b.station_m, lane) = propellant.station_m;
  Lane(b.outer2_m2, lane) = propellant.outer_radius_m * propellant.outer_radius_m;
  Lane(b.inner_per_kg_m2, lane) =
      propellant.kilograms_per_area_m2 > 0.0 ? 1.0 / propellant.kilograms_per_area_m2 : 0.0;
  Lane(b.length2_m2, lane) = propellant.length_m * propellant.length_m / 12.0;
  Lane(b.radius2_m2, lane) = propellant.radius_m * propellant.radius_m;
  b.drains = propellant.drains;
  SetLane(b.tanks, lane, propellant.tanks);
  b.any_mixes = IsAnywhere(b.tanks.second_kg_m2);
}

/// Adds tubes of propellant whose axes are off the vehicle's axis by a radius, spread evenly about it.
/// `own_axial_kg_m2`: their moments of inertia about their own axes. `length2_m2`: their length squared, over
/// 12; of liquids, which have none about the axis, their gyration2_m2. By Huygens and Steiner, from both
/// centres to the common one.
template <class T>
DISPERSA_INLINE void AddTubes(T kg, T own_axial_kg_m2, T station_m, T length2_m2, T radius2_m2,
                              MassPropertiesOf<T>& m) {
  const T apart = kg * radius2_m2;
  const T old_cg = m.cg_station_m, old_kg = m.mass_kg;
  m.mass_kg = old_kg + kg;
  m.cg_station_m = Fma(kg, station_m, old_kg * old_cg) / m.mass_kg;
  m.axial_inertia_kg_m2 = m.axial_inertia_kg_m2 + own_axial_kg_m2 + apart;
  m.transverse_inertia_kg_m2 =
      m.transverse_inertia_kg_m2 + old_kg * Square(m.cg_station_m - old_cg) +
      Fma(T(0.5), own_axial_kg_m2 + apart, kg * (length2_m2 + Square(station_m - m.cg_station_m)));
}

/// AddBeside of tanks. A function of its own: few vehicles need it.
template <class T>
DISPERSA_OUT_OF_LINE MassPropertiesOf<T> WithTanksBeside(const BesideStage<T>& b, T beside_kg, T beside_kg_s,
                                                         T flow_kg_s, MassPropertiesOf<T> m) {
  const T none(0.0), one(1.0), half(0.5);
  const BoosterLiquids<T> liquids = LiquidsOf(b.tanks, b.any_mixes, beside_kg);
  const T old_cg = m.cg_station_m;
  AddTubes(beside_kg, none, liquids.station_m, liquids.gyration2_m2, b.radius2_m2, m);
  const T total_kg_s = beside_kg_s + flow_kg_s;
  const T share = Select(total_kg_s > none, beside_kg_s / Select(total_kg_s > none, total_kg_s, one), none);
  const T moved = Square(m.source_station_m - m.cg_station_m) - Square(m.source_station_m - old_cg);
  const T beside_transverse =
      Fma(half, b.radius2_m2, liquids.surface_gyration2_m2) + Square(liquids.surface_m - m.cg_station_m);
  m.axial_inertia_per_kg = m.axial_inertia_per_kg + share * (b.radius2_m2 - m.axial_inertia_per_kg);
  const T own_transverse = m.transverse_inertia_per_kg + moved;
  m.transverse_inertia_per_kg = own_transverse + share * (beside_transverse - own_transverse);
  m.source_station_m = m.source_station_m + share * (liquids.surface_m - m.source_station_m);
  return m;
}

/// Adds `beside_kg` of the boosters' propellant, of which `beside_kg_s` flows beside the stage's own
/// `flow_kg_s`. Rates by mass and the place that mass comes from become those of both flows together.
template <class T>
DISPERSA_INLINE void AddBeside(const BesideStage<T>& b, T beside_kg, T beside_kg_s, T flow_kg_s,
                               MassPropertiesOf<T>& m) {
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
  m.axial_inertia_per_kg = m.axial_inertia_per_kg + share * (beside_axial - m.axial_inertia_per_kg);
  const T own_transverse = m.transverse_inertia_per_kg + moved;
  m.transverse_inertia_per_kg = own_transverse + share * (beside_transverse - own_transverse);
  m.source_station_m = m.source_station_m + share * (b.station_m - m.source_station_m);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
