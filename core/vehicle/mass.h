// Mass, centre of gravity and inertia of a stack as its lowest stage's propellant burns.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Mass properties of an axisymmetric stack. Inertias are about its centre of gravity, along and across the
/// axis.
template <class T>
struct MassPropertiesOf {
  T mass_kg = T(0.0);
  T cg_station_m = T(0.0);
  T axial_inertia_kg_m2 = T(0.0);
  T transverse_inertia_kg_m2 = T(0.0);
  T axial_inertia_per_kg = T(0.0);       ///< derivative by propellant mass, m²
  T transverse_inertia_per_kg = T(0.0);  ///< derivative by propellant mass about the moving CG, m²
  /// Where mass goes: the grain's middle, or the surfaces of the liquids, by their shares.
  T source_station_m = T(0.0);
};
using MassProperties = MassPropertiesOf<double>;

/// Liquids that drain in a constant mixture: polynomials of the remaining mass m.
///
/// In a cylinder of radius r, its bottom at station b, mass m_k = s_k m of density rho stands h = m_k / (rho
/// pi r²) high. Its first moment about station 0 is m_k (b - h/2), its second m_k (b² - b h + h²/3 + r²/4).
/// In pitch and yaw the liquid counts as frozen, which is its greatest inertia. In roll it counts as none: a
/// smooth wall does not turn an inviscid liquid. Free liquid resists pitching less, by up to a half in a
/// squat tank (H. N. Abramson (ed.), "The Dynamic Behavior of Liquids in Moving Containers", NASA SP-106,
/// 1966, chapters 2 and 6). Sloshing is not modelled.
template <class T>
struct DrainingMassOf {
  T first_per_kg_m = T(0.0), first_per_kg2_m = T(0.0);  ///< first moment m (a + b m)
  /// Second moment m (a + b m + c m²).
  T second_per_kg_m2 = T(0.0), second_per_kg2_m2 = T(0.0), second_per_kg3_m2 = T(0.0);
  /// Added to both moments by a mixture that differs from the tanks' loads (MixtureOf).
  T first_kg_m = T(0.0), second_kg_m2 = T(0.0);
};
using DrainingMass = DrainingMassOf<double>;

/// All masses of a stack but the burning propellant, summed once, and the burning grain or the draining
/// tanks.
///
/// The grain burns from its bore outwards at constant length. With the propellant's density rho: r_i² = r_o²
/// - m / (pi rho L). Its inertias are those of a tube. Parallel axes by Huygens and Steiner.
template <class T>
struct StackSums {
  T fixed_mass_kg = T(0.0);
  T fixed_first_moment_kg_m = T(0.0);    ///< about station 0
  T fixed_second_moment_kg_m2 = T(0.0);  ///< transverse, about station 0, own inertias included
  T fixed_axial_inertia_kg_m2 = T(0.0);
  T grain_station_m = T(0.0);
  T grain_outer2_m2 = T(0.0);        ///< its outer radius squared
  T grain_inner_per_kg_m2 = T(0.0);  ///< by which each kilogram lowers its bore's radius squared
  T grain_length2_m2 = T(0.0);       ///< its length squared, over 12
  DrainingMassOf<T> tanks;
};
struct StackMass : StackSums<double> {
  double propellant_mass_kg = 0.0;  ///< at ignition
  bool drains = false;              ///< tanks in place of the grain
  const MassRows* table = nullptr;  ///< in place of grain or tanks (null: none), the stage's own
  SideSums sides{};                 ///< of all but the burning propellant, by tables of its stages

  /// About the centre of gravity of the masses as if all were on the axis.
  MassProperties At(double propellant_kg) const;
  SideSums SidesAt(double propellant_kg) const;
  /// Whether a table knows masses off the axis.
  bool HasSides() const;
};

/// Jettisoned bodies as part of a stack's sums. They are numbered in the order of the stages and, within a
/// stage, of its list.
struct JettisonedMass {
  int stage = 0;  ///< that carries it, 0-based
  double mass_kg = 0.0;
  double first_moment_kg_m = 0.0;
  double second_moment_kg_m2 = 0.0;
  double axial_inertia_kg_m2 = 0.0;
};
std::vector<JettisonedMass> BuildJettisonedMasses(const Vehicle& vehicle);
/// The boosters' bit beside those of the jettisoned bodies.
inline constexpr unsigned kBoostersGone = 1u << kMaxJettisons;
/// Those that the stack of a stage carries, as bits, boosters among them.
unsigned CarriedBy(const Vehicle& vehicle, int stage);

/// A stack without what has been jettisoned: bit i of `gone` stands for jettison i, whether the stack carried
/// it or not.
StackMass Without(StackMass stack, int lowest_stage, const std::vector<JettisonedMass>& jettisons,
                  unsigned gone);

/// Everything of a vehicle's boosters together, empty, as the first stack's sums count it.
JettisonedMass BuildBoosterMass(const Boosters& boosters);
/// The propellant of all boosters together: the sums grow with its mass. Each grain burns from its bore
/// outwards. Tanks drain as those of a stage, each about its booster's axis.
struct BoosterPropellant {
  double radius_m = 0.0;   ///< of their axes from the vehicle's
  double station_m = 0.0;  ///< of the grains' middles
  double length_m = 0.0;
  double outer_radius_m = 0.0;
  double kilograms_per_area_m2 = 0.0;  ///< of all: by which the sections' area, over pi, shrinks
  bool drains = false;                 ///< tanks in place of grains
  DrainingMass tanks = {};             ///< of all, by the mass in all
};
BoosterPropellant BuildBoosterPropellant(const Boosters& boosters);

/// The flow of an engine's tanks by a mixture ratio that is `factor` times the one in which they are loaded.
///
/// The ratio R is the flow from the first tank over that from the others, which keep theirs: the first one's
/// share becomes f R / (1 + f R). With shares s_k of the flow and loads M_k of all M, m_k = M_k - s_k (M -
/// m). Thrust, flow and specific impulse stay. The burn ends when the first tank has only its part of the
/// residual left, so the residual grows. The definition is our own.
struct MixtureOf {
  DrainingMass tanks;      ///< by the mass in all of them
  double residual_kg = 0;  ///< that stays
};
/// Of full tanks with `load_kg` in all. `residual_kg` stays in the mixture of their loads.
MixtureOf BuildMixture(const std::vector<Tank>& tanks, double load_kg, double residual_kg, double factor);

/// Dry mass of a stage, for any of its burns: its lift-off mass less the stages above, its propellant, its
/// jettisoned bodies and boosters.
double DryMass(const Vehicle& vehicle, int stage);
/// Propellant density of a solid motor that follows from the grain's volume, kg/m³.
double PropellantDensity(const Stage& stage);
/// One entry a stack. Stack i has stages i, i+1, ... attached, with everything that they carry at lift-off.
/// Their tables are the vehicle's: it lives longer.
std::vector<StackMass> BuildStackMasses(const Vehicle& vehicle);
std::vector<StackMass> BuildStackMasses(Vehicle&& vehicle) = delete;

}  // namespace dispersa
