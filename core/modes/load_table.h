// Data for the loads of a stack's cross-sections: where the normal force acts along the body, and the inertia
// of the mass ahead of a station. Plain data, for dynamics/body_sections.h.
#pragma once

#include <array>

#include "core/modes/lift_distribution.h"

namespace dispersa {

/// The most cross-sections that are looked at (load_stations.h).
inline constexpr int kLoadStations = 40;
/// The first ones, which tell whether the others need a look.
inline constexpr int kScoutStations = 4;

template <class T>
struct LoadNumbers {
  T scouts_see = T(0.0);  ///< LoadStations::scouts_see
  /// Moment arm (m) about each station of the normal force ahead of it, per force: by slender-body theory.
  /// Added to it: `shift_arm` for each metre of the centre of pressure aft of lift.slender_station_m.
  std::array<T, kLoadStations> slender_arm_m{}, shift_arm{};

  /// Stations s, and integrals over the mass ahead of each. m(x) is the mass per length, g(x) the radius of
  /// gyration of the cross-section, and p the propellant. The integral of m (s - x) is first[0] + first[1] p
  /// + first[2] p². The integral of m (s - x) x - m g² is second[0] + second[1] p + second[2] p². For a grain
  /// this is exact, with first[2] = 0. For liquids with a surface that passes the station, it is the parabola
  /// through full, half full and empty.
  std::array<T, kLoadStations> station_m{};
  std::array<std::array<T, 3>, kLoadStations> first_kg_m{}, second_kg_m2{};
};
struct LoadTable : LoadNumbers<double> {
  LiftDistribution lift;
  int stations = 0;
};

/// The table for the stack of stages `stage` (from 0) and above, without boosters, whose loads come and go in
/// flight (dynamics/booster_push.h). Masses are those of the finite-element beam (beam_masses.h). `nominal`:
/// a table of the same stack with other masses, whose stations it takes (null: it chooses its own).
LoadTable BuildLoadTable(const Vehicle& vehicle, int stage, const LoadTable* nominal = nullptr);

/// A table without loads, for lanes without one. It is made here: code of one instruction set must not hold
/// the destructor of a type that all share.
const LoadTable& NoLoads();

}  // namespace dispersa
