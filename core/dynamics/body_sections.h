// Cross-sections of W launch vehicles side by side (core/math/lanes.h): where the flow presses along the
// body, and the bending moment that each section carries.
#pragma once

#include <type_traits>

#include "core/dynamics/body_flow.h"
#include "core/math/lane_vector.h"
#include "core/modes/load_table.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// LoadTable of each lane's stack.
template <class T>
struct Sections : LoadNumbers<T> {
  T slender_station_m;
  int stations = 0;  ///< of any lane; a lane with fewer has no moment at the others
};
/// `table` null: nothing is known of this lane's sections.
template <class T>
DISPERSA_INLINE void SetSections(Sections<T>& s, int lane, const LoadTable* table) {
  const LoadTable& from = table ? *table : NoLoads();
  SetLane<LoadNumbers>(s, lane, from);
  Lane(s.slender_station_m, lane) = from.lift.slender_station_m;
  s.stations = s.stations > from.stations ? s.stations : from.stations;
}

/// Motion of the body: acceleration at C without gravitation, and its growth for each metre ahead of C.
/// `turn_z` grows along y, `turn_y` along -z.
template <class T>
struct BodyMotion {
  T propellant_kg, cg_station_m;
  T lateral_y_m_s2, lateral_z_m_s2, turn_y_1_s2, turn_z_1_s2;
};
/// Of what the scouts see: drawn masses and air are not quite those of the family (load_stations.h).
inline constexpr double kScoutMargin = 0.9;

/// The largest bending moment, and where.
template <class T>
struct LargestMoment {
  T moment_n_m, station_m;
};

/// No further loads on the sections. Others have AddAt(station, y_n_m, z_n_m), which adds to the moments
/// about z (of forces along y) and about -y (along z).
struct NoFurtherLoads {};
template <class Loads>
inline constexpr bool kHasLoads = !std::is_same_v<Loads, NoFurtherLoads>;

/// Bending moments at all load stations. A section carries the force for the acceleration of the mass ahead,
/// minus the flow's force there, plus the loads by bending and by bodies beside (force summation: R. L.
/// Bisplinghoff, H. Ashley, R. L. Halfman, "Aeroelasticity", 1955). Left out: the flow's damping moment,
/// forces of the propellant flow, and the axial force on the bent axis. `side`: of the yaw plane, with
/// kTwoPlanes. A lane looks beyond its scouts where their moment, with the most that bending may add, says
/// that the largest may be above `seen_n_m`.
template <class T, bool kTwoPlanes, class Bending, class Beside>
DISPERSA_INLINE LargestMoment<T> LargestOfPlanes(const Sections<T>& body, const NormalForce<T>& air,
                                                 const SideForce<T>* side, const BodyMotion<T>& m, T seen_n_m,
                                                 const Bending& bending, const Beside& beside) {
  T largest2(0.0), station(0.0);
  const T aft = air.xcp_station_m - body.slender_station_m;
  T side_n = air.normal_n, side_aft = aft;
  if constexpr (kTwoPlanes) {
    side_n = side->normal_n;
    side_aft = side->xcp_station_m - body.slender_station_m;
  }
  const T y_n = side_n * air.across_y, z_n = air.normal_n * air.across_z;
  const T *const slender_arm_m = body.slender_arm_m.data(), *const shift_arm = body.shift_arm.data();
  const auto look = [&](int begin, int end, const auto& lanes, const auto& bent)
      __attribute__((always_inline)) {
    constexpr bool kBends = kHasLoads<std::remove_cvref_t<decltype(bent)>>;
    for (int i = begin; i < end; ++i) {
      const T* f = body.first_kg_m.data()[i].data();
      const T* s = body.second_kg_m2.data()[i].data();
      const T first = Fma(m.propellant_kg, Fma(m.propellant_kg, f[2], f[1]), f[0]);
      const T turned =
          Fma(m.cg_station_m, first, -Fma(m.propellant_kg, Fma(m.propellant_kg, s[2], s[1]), s[0]));
      const T arm = Fma(aft, shift_arm[i], slender_arm_m[i]);
      T side_arm = arm;
      if constexpr (kTwoPlanes) side_arm = Fma(side_aft, shift_arm[i], slender_arm_m[i]);
      T y = Fma(m.lateral_y_m_s2, first, Fma(m.turn_z_1_s2, turned, y_n * side_arm));
      T z = Fma(m.lateral_z_m_s2, first, Fma(-m.turn_y_1_s2, turned, z_n * arm));
      if constexpr (kBends || kHasLoads<Beside>) {
        T more_y(0.0), more_z(0.0);
        if constexpr (kBends) bent.AddAt(i, more_y, more_z);
        if constexpr (kHasLoads<Beside>) beside.AddAt(i, more_y, more_z);
        y = y + more_y;
        z = z + more_z;
      }
      const T size2 = Fma(y, y, z * z);
      const auto is_larger = lanes & (size2 > largest2);
      largest2 = Select(is_larger, size2, largest2);
      station = Select(is_larger, body.station_m.data()[i], station);
    }
  };
  const auto all = T(0.0) < T(1.0);
  const int scouts = body.stations < kScoutStations ? body.stations : kScoutStations;
  look(0, scouts, all, NoFurtherLoads{});
  const auto know_of_more = [&](T than_n_m) __attribute__((always_inline)) {
    const T enough = T(kScoutMargin) * body.scouts_see * than_n_m;
    return largest2 > enough * enough;
  };
  auto may_be_larger = know_of_more(seen_n_m);
  if constexpr (kHasLoads<Bending>) {
    const T most_n_m = bending.Most();
    may_be_larger = (most_n_m > seen_n_m) | know_of_more(Max(seen_n_m - most_n_m, T(0.0)));
  }
  if (Any(may_be_larger)) {
    // The scouts did not see how the body bends.
    if constexpr (kHasLoads<Bending>) largest2 = Select(may_be_larger, T(0.0), largest2);
    look(kHasLoads<Bending> ? 0 : scouts, body.stations, may_be_larger, bending);
  }
  return {Sqrt(largest2), station};
}

/// Out of line: most bodies have one plane, and pay nothing.
template <class T, class Bending, class Beside>
DISPERSA_OUT_OF_LINE LargestMoment<T> LargestOfTwoPlanes(const Sections<T>& body, const NormalForce<T>& air,
                                                         const SideForce<T>& side, const BodyMotion<T>& m,
                                                         T seen_n_m, const Bending& bending,
                                                         const Beside& beside) {
  return LargestOfPlanes<T, true>(body, air, &side, m, seen_n_m, bending, beside);
}

/// `side`: of the yaw plane (null: as the pitch plane).
template <class T, class Bending = NoFurtherLoads, class Beside = NoFurtherLoads>
DISPERSA_INLINE LargestMoment<T> LargestOf(const Sections<T>& body, const NormalForce<T>& air,
                                           const SideForce<T>* side, const BodyMotion<T>& m, T seen_n_m,
                                           const Bending& bending = {}, const Beside& beside = {}) {
  return side ? LargestOfTwoPlanes(body, air, *side, m, seen_n_m, bending, beside)
              : LargestOfPlanes<T, false>(body, air, side, m, seen_n_m, bending, beside);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
