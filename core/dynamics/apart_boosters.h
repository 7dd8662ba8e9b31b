// Boosters of W vehicles side by side (core/math/lanes.h). Each is a body of its own: it has its place, its
// burn and its nozzle, so the centre of gravity is off the axis and the moments of inertia differ.
//
// Frames and signs as in launcher_body.h: B at the vehicle's axis, x forward, stations aft. A booster k
// stands at (y_k, z_k). Its shell is a thin tube. Its grain burns from its bore outwards, or its tanks drain
// (DrainingMass). Each counts by
// Huygens and Steiner: moments about x, y, z and products of inertia are exact for the boosters. The rest of
// the vehicle is axisymmetric. Motions of the centre of gravity across the body (millimetres a second) are
// left out, as for a dispersed offset.
// The flow of the stage itself counts as if C were on the axis.
//
// Flow m_dot_k leaves the propellant and goes out of the nozzle at r_k from C. The angular momentum that it
// takes from a turning body, less the inertia that the body loses: m_dot_k (J_k w - r_k x (w x r_k)), with
// J_k the inertia about C of a kilogram at the propellant's surface.
#pragma once

#include "core/dynamics/body_flow.h"
#include "core/dynamics/launcher.h"
#include "core/dynamics/off_axis.h"
#include "core/math/lane_vector.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
struct ApartBooster {
  BurningMotor<T> burn;
  T y_m, z_m, dry_kg;
  DrainingMassOf<T> tanks;
  bool any_mixes;
  Vector<T> along;          ///< its thrust undeflected: canted and misaligned
  Vector<T> first, second;  ///< across it, where a positive angle turns the thrust about each hinge
  MaskOf<T> burning;
  T fraction, flow_kg_s, kg;  ///< now: of full thrust; propellant
  // Now, of the kilogram that leaves next: its place, and squares of its radii of gyration along the
  // booster's axis and across it, about that place.
  T source_station_m, source_axial_m2, source_across_m2;
};
template <class T>
struct ApartBoosters {
  int count, first_bank;  ///< those of their nozzles
  bool turn_nozzles;
  MaskOf<T> attached;  ///< lanes that carry them
  T nozzle_station_m, attachment_station_m;
  T dry_station_m, dry_axial_m2, dry_across_m2;  ///< squares of the empty ones' radii of gyration
  T grain_station_m, outer2_m2, inner_per_kg_m2, length2_m2, radius2_m2;
  bool drains;  ///< tanks in place of grains: of the vehicle, the same in all lanes
  /// The air of the stage without boosters, if the vehicle's tables know it.
  bool knows_core_air;
  BodyInFlow<T> core_air;
  ApartBooster<T> each[kMaxBoosters];
  // Now, of all that are attached.
  T flow_kg_s;
  OffAxis<T> off;
};

template <class T>
DISPERSA_INLINE void SetBoosters(ApartBoosters<T>& a, int lane, const BoosterSet& set, bool are_attached) {
  a.count = static_cast<int>(set.each.size());
  a.turn_nozzles = set.gimbal.limit_rad > 0.0;
  SetLane(a.attached, lane, are_attached);
  Lane(a.nozzle_station_m, lane) = set.nozzle_station_m;
  Lane(a.attachment_station_m, lane) = set.attachment_station_m;
  // Of all together: their distance from the axis counts whole in roll and by half across.
  const double dry_m = set.empty.first_moment_kg_m / set.empty.mass_kg, apart2 = set.radius_m * set.radius_m;
  Lane(a.dry_station_m, lane) = dry_m;
  Lane(a.dry_axial_m2, lane) = set.empty.axial_inertia_kg_m2 / set.empty.mass_kg - apart2;
  Lane(a.dry_across_m2, lane) =
      set.empty.second_moment_kg_m2 / set.empty.mass_kg - 0.5 * apart2 - dry_m * dry_m;
  const BoosterPropellant& g = set.propellant;
  a.drains = g.drains;
  Lane(a.grain_station_m, lane) = g.station_m;
  Lane(a.outer2_m2, lane) = g.outer_radius_m * g.outer_radius_m;
  Lane(a.inner_per_kg_m2, lane) = g.drains ? 0.0 : a.count / g.kilograms_per_area_m2;
  Lane(a.length2_m2, lane) = g.length_m * g.length_m / 12.0;
  Lane(a.radius2_m2, lane) = apart2;
  for (int k = 0; k < a.count; ++k) {
    ApartBooster<T>& one = a.each[k];
    const EachBooster& from = set.each.data()[k];
    SetBurn(one.burn, lane, from.burn);
    SetLane(one.tanks, lane, from.tanks);
    one.any_mixes = IsAnywhere(one.tanks.second_kg_m2);
    Lane(one.dry_kg, lane) = from.dry_kg;
    Lane(one.y_m, lane) = from.y_m;
    Lane(one.z_m, lane) = from.z_m;
    SetLane(one.along, lane, VectorAt(from.along.data()));
    SetLane(one.first, lane, VectorAt(from.first.data()));
    SetLane(one.second, lane, VectorAt(from.second.data()));
    SetLane(one.burning, lane, false);
  }
}

/// Where the propellant of a booster lies, and what leaves it next. Returns its centre's station. Of liquids
/// it adds their moments to `first` and `second`.
template <class T>
DISPERSA_INLINE T LieIn(const ApartBoosters<T>& a, ApartBooster<T>& b, T& first, T& second) {
  if (!a.drains) {
    b.source_station_m = a.grain_station_m;
    b.source_axial_m2 = Fma(-b.kg, a.inner_per_kg_m2, a.outer2_m2);
    b.source_across_m2 = Fma(T(0.5), b.source_axial_m2, a.length2_m2);
    return a.grain_station_m;
  }
  const BoosterLiquids<T> liquids = LiquidsOf(b.tanks, b.any_mixes, b.kg);
  b.source_station_m = liquids.surface_m;
  b.source_axial_m2 = T(0.0);
  b.source_across_m2 = liquids.surface_gyration2_m2;
  first = Fma(b.kg, liquids.station_m, first);
  second = Fma(b.kg, liquids.gyration2_m2 + Square(liquids.station_m), second);
  return liquids.station_m;
}

/// `m` with the boosters' propellant; says also how their masses lie. Rates by mass and the place that mass
/// comes from become such that the whole flow times them is what the stage's own flow does; the boosters'
/// part is in LoadsOfApart. By value: a reference would keep `m` in memory for vehicles without boosters too.
template <class T>
DISPERSA_OUT_OF_LINE MassPropertiesOf<T> WithApart(ApartBoosters<T>& a, T since_ignition_s, T flow_kg_s,
                                                   MassPropertiesOf<T> m) {
  const T none(0.0), half(0.5), one(1.0);
  T beside_kg(0.0), own_axial(0.0), first(0.0), second(0.0), surfaces(0.0);
  a.flow_kg_s = none;
  OffAxis<T>& off = a.off;
  off = {none, none, none, none, none, none};
  for (int k = 0; k < a.count; ++k) {
    ApartBooster<T>& b = a.each[k];
    const BurnState<T> burn = BurnAt(b.burn, since_ignition_s);
    b.fraction = Select(b.burning, burn.fraction, none);
    b.flow_kg_s = Select(b.burning, b.burn.full_flow_kg_s * burn.flow_fraction, none);
    b.kg = Select(b.burning, burn.propellant_kg, Select(a.attached, b.burn.left_kg, none));
    const T station_m = LieIn(a, b, first, second);
    surfaces = Fma(b.flow_kg_s, b.source_station_m, surfaces);
    a.flow_kg_s = a.flow_kg_s + b.flow_kg_s;
    beside_kg = beside_kg + b.kg;
    own_axial = own_axial + half * b.kg * Fma(-b.kg, a.inner_per_kg_m2, T(2.0) * a.outer2_m2);
    const T all_kg = b.dry_kg + b.kg;
    const T stations = Fma(b.kg, station_m, b.dry_kg * a.dry_station_m);
    off.y_kg_m = Fma(all_kg, b.y_m, off.y_kg_m);
    off.z_kg_m = Fma(all_kg, b.z_m, off.z_kg_m);
    off.station_y_kg_m2 = Fma(stations, b.y_m, off.station_y_kg_m2);
    off.station_z_kg_m2 = Fma(stations, b.z_m, off.station_z_kg_m2);
    off.about_y_kg_m2 = Fma(half * all_kg, b.z_m * b.z_m - b.y_m * b.y_m, off.about_y_kg_m2);
    off.yz_kg_m2 = Fma(all_kg, b.y_m * b.z_m, off.yz_kg_m2);
  }
  for (T* sum : {&off.y_kg_m, &off.z_kg_m, &off.station_y_kg_m2, &off.station_z_kg_m2, &off.about_y_kg_m2,
                 &off.yz_kg_m2})
    *sum = Select(a.attached, *sum, none);
  const T old_cg = m.cg_station_m;
  T station_m = a.grain_station_m, length2_m2 = a.length2_m2, source_m = a.grain_station_m;
  if (a.drains) {  // all liquids together
    const T inverse_kg = one / Select(beside_kg > none, beside_kg, one);
    station_m = first * inverse_kg;
    length2_m2 = Fma(second, inverse_kg, -Square(station_m));
    own_axial = none;
    source_m = Select(a.flow_kg_s > none, surfaces / Select(a.flow_kg_s > none, a.flow_kg_s, one), station_m);
  }
  AddTubes(beside_kg, own_axial, station_m, length2_m2, a.radius2_m2, m);
  const T total_kg_s = a.flow_kg_s + flow_kg_s;
  const T own = Select(total_kg_s > none, flow_kg_s / Select(total_kg_s > none, total_kg_s, one), one);
  const T moved = Square(m.source_station_m - m.cg_station_m) - Square(m.source_station_m - old_cg);
  m.axial_inertia_per_kg = own * m.axial_inertia_per_kg;
  m.transverse_inertia_per_kg = own * (m.transverse_inertia_per_kg + moved);
  m.source_station_m = source_m + own * (m.source_station_m - source_m);
  return m;
}

/// Forces of the boosters, with their moments about C at (cg_station, cg_y, cg_z), and the moment by which
/// their flows turn the body. `angles`: sines and cosines of the deflections of their nozzles.
template <class T>
struct ApartLoads {
  Vector<T> force_n, moment_n_m;
  T thrust_n;
};
template <class T, class Bank>
DISPERSA_OUT_OF_LINE ApartLoads<T> LoadsOfApart(const ApartBoosters<T>& a, const Bank* banks, T pressure_pa,
                                                T cg_station_m, T cg_y_m, T cg_z_m, bool damps,
                                                const Vector<T>& w) {
  const T none(0.0);
  ApartLoads<T> o{Zero<T>(), Zero<T>(), none};
  for (int k = 0; k < a.count; ++k) {
    const ApartBooster<T>& b = a.each[k];
    const T net_n = Fma(b.burn.vacuum_thrust_n, b.fraction, -(pressure_pa * b.burn.exit_area_m2));
    const T push_n = Select(b.burning & (net_n > none), net_n, none);
    Vector<T> along = b.along;
    if (a.turn_nozzles) {
      const Bank& bank = banks[a.first_bank + k / kNozzles];
      const int i = k % kNozzles;
      const T cosine = bank.second.cosine[i];
      along = (bank.first.cosine[i] * cosine) * b.along + (bank.first.sine[i] * cosine) * b.first +
              bank.second.sine[i] * b.second;
    }
    const Vector<T> force = push_n * along;
    const Vector<T> place{cg_station_m - a.nozzle_station_m, b.y_m - cg_y_m, b.z_m - cg_z_m};
    o.thrust_n = o.thrust_n + push_n;
    o.force_n = o.force_n + force;
    o.moment_n_m = o.moment_n_m + Cross(place, force);
    // J w of the kilogram that leaves next about C, and what the flow takes out of the nozzle.
    const Vector<T> source{cg_station_m - b.source_station_m, place.y, place.z};
    const T across = b.source_across_m2;
    const Vector<T> spin =
        Vector<T>{b.source_axial_m2 * w.x, across * w.y, across * w.z} + Cross(source, Cross(w, source));
    const Vector<T> taken = damps ? Cross(place, Cross(w, place)) : Zero<T>();
    o.moment_n_m = o.moment_n_m + b.flow_kg_s * (spin - taken);
  }
  return o;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
