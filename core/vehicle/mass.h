// Mass, centre of gravity and inertia of a stack as its lowest stage's propellant burns.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Of an axisymmetric stack; inertias about its CG, along and across the axis.
struct MassProperties {
  double mass_kg = 0.0;
  double cg_station_m = 0.0;
  double axial_inertia_kg_m2 = 0.0;
  double transverse_inertia_kg_m2 = 0.0;
  double axial_inertia_per_kg = 0.0;       ///< derivative by propellant mass, m²
  double transverse_inertia_per_kg = 0.0;  ///< likewise, about the moving CG
};

/// Liquids that drain, all in the same proportion (a constant mixture): polynomials of the mass m that is
/// left.
///
/// In a cylinder of radius r, its bottom at station b, mass m_k = s_k m of density rho stands h = m_k / (rho
/// pi r²) high. Its first moment about station 0 is m_k (b - h/2), its second m_k (b² - b h + h²/3 + r²/4):
/// in pitch and yaw the liquid counts as if frozen, which is the most that it can resist; in roll as none at
/// all, since a smooth wall does not turn an inviscid liquid. (H. N. Abramson (ed.), "The Dynamic Behavior of
/// Liquids in Moving Containers", NASA SP-106, 1966, chapters 2 and 6: liquid that is free resists pitching
/// less, by up to a half in a squat tank.) Sloshing is not in it.
struct DrainingMass {
  double first_per_kg_m = 0.0, first_per_kg2_m = 0.0;  ///< first moment m (a + b m)
  /// Second moment m (a + b m + c m²).
  double second_per_kg_m2 = 0.0, second_per_kg2_m2 = 0.0, second_per_kg3_m2 = 0.0;
};

/// Everything of a stack but the burning propellant, summed once, and the grain that burns, or the tanks that
/// drain.
///
/// The grain burns from its bore outwards at constant length: with rho the propellant's density,
/// r_i² = r_o² - m / (pi rho L); its inertias are those of a tube. Parallel axes by Huygens and Steiner.
struct StackMass {
  double fixed_mass_kg = 0.0;
  double fixed_first_moment_kg_m = 0.0;    ///< about station 0
  double fixed_second_moment_kg_m2 = 0.0;  ///< transverse, about station 0, own inertias included
  double fixed_axial_inertia_kg_m2 = 0.0;
  double grain_station_m = 0.0;
  double grain_length_m = 0.0;
  double grain_outer_radius_m = 0.0;
  double grain_density_kg_m3 = 0.0;
  double propellant_mass_kg = 0.0;  ///< at ignition
  bool drains = false;              ///< tanks in place of the grain
  DrainingMass tanks;

  MassProperties At(double propellant_kg) const;
};

/// What is jettisoned, as a stack's sums count it. Jettisons are numbered in the order of the stages, and as
/// each stage lists its own.
struct JettisonedMass {
  int stage = 0;  ///< that carries it, 0-based
  double mass_kg = 0.0;
  double first_moment_kg_m = 0.0;
  double second_moment_kg_m2 = 0.0;
  double axial_inertia_kg_m2 = 0.0;
};
std::vector<JettisonedMass> BuildJettisonedMasses(const Vehicle& vehicle);

/// A stack without what has been jettisoned: bit i of `gone` stands for jettison i, whether the stack carried
/// it or not.
StackMass Without(StackMass stack, int lowest_stage, const std::vector<JettisonedMass>& jettisons,
                  unsigned gone);

/// Everything of a vehicle's boosters together, empty, as the first stack's sums count it.
JettisonedMass BuildBoosterMass(const Boosters& boosters);
/// The propellant of all boosters together: the sums grow with its mass. Each grain burns from its bore
/// outwards.
struct BoosterGrains {
  double station_m = 0.0;  ///< of the middles
  double length_m = 0.0;
  double outer_radius_m = 0.0;
  double radius_m = 0.0;               ///< of their axes from the vehicle's
  double kilograms_per_area_m2 = 0.0;  ///< of all: by which the sections' area, over pi, shrinks
};
BoosterGrains BuildBoosterGrains(const Boosters& boosters);

/// Dry mass of a stage, whichever burn of it is asked for: its lift-off mass less what is above, its
/// propellant, what it jettisons and boosters.
double DryMass(const Vehicle& vehicle, int stage);
/// Propellant density that the grain's volume implies, kg/m³; of a solid motor.
double PropellantDensity(const Stage& stage);
/// One entry a stack; stack i has stages i, i+1, ... attached, with everything that they carry at lift-off.
std::vector<StackMass> BuildStackMasses(const Vehicle& vehicle);

}  // namespace dispersa
