// Mass distribution of a stack's beam: the vehicle's mass model along the axis.
#pragma once

#include <array>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Mass spread over a length of the beam, which moves with it. At station x its mass per length is
/// mass_per_length(x) (scale[0] + scale[1] x + scale[2] x²).
struct SpreadMass {
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  Taper mass_per_length_kg_m;
  Taper gyration2_m2;  ///< of a cross-section about its diameter, squared: (r_o² + r_i²) / 4 of a tube
  std::array<double, 3> scale = {1.0, 0.0, 0.0};

  /// The same mass and radius of gyration everywhere: the values at the top.
  bool IsUniform() const {
    return mass_per_length_kg_m.top == mass_per_length_kg_m.bottom &&
           gyration2_m2.top == gyration2_m2.bottom && scale == std::array<double, 3>{1.0, 0.0, 0.0};
  }
  double MassPerLength(double station_m) const;
  double Gyration2(double station_m) const;
};

/// A rigid body fixed to the beam at one station.
struct FixedMass {
  double station_m = 0.0;
  double mass_kg = 0.0;
  double cg_station_m = 0.0;
  double inertia_kg_m2 = 0.0;  ///< about its own centre of gravity, across the axis
};

struct BeamMasses {
  std::vector<SpreadMass> spread;
  std::vector<FixedMass> fixed;
};

/// The masses of the stack of stages `stage` (from 0) and above, with `propellant_kg` left in its lowest
/// stage. Bit i of `gone`: jettison i (BuildJettisonedMasses) has left. kBoostersGone: the boosters have.
///
/// Structure elements, jettisoned bodies and grains are the tubes of the mass model. They are spread evenly
/// over their length, or fixed at one station if the beam lumps them. So mass, centre of gravity and
/// transverse inertia are those of StackMass::At to rounding, at any level, with or without a beam. A stage
/// that gives its own masses has them scaled (ScaleOwnMasses), and so has a stage with a mass table. Boosters
/// are rigid bodies at their attachment station, with the propellant that they have by the nominal burns
/// (booster_course.h).
BeamMasses BuildBeamMasses(const Vehicle& vehicle, int stage, double propellant_kg, unsigned gone = 0);

/// Whether the beam has this element of its stage's structure, or jettisoned body, among its lumped masses.
bool IsLumped(const BeamStage& stage, const std::string& element);

/// Scaling of a stage's own mass per length to its mass model. It is multiplied by the quadratic polynomial
/// in station that makes mass, first and second moment, with the lumped masses, those of the dry stage. The
/// lumped masses stay.
struct OwnMassScale {
  std::array<double, 3> polynomial = {1.0, 0.0, 0.0};
  double least = 0.0;  ///< of the polynomial over the sections
  double greatest = 0.0;
  double given_kg = 0.0;  ///< as the file has it, lumped masses included
  double given_cg_m = 0.0;
  double stage_kg = 0.0;  ///< as the mass model has it
  double stage_cg_m = 0.0;
};
OwnMassScale ScaleOwnMasses(const Vehicle& vehicle, int stage);
/// The same for a stage with a mass table, whose parts and propellant are multiplied by one polynomial at
/// each propellant. Returned: the least and the greatest value of the polynomial over the parts.
struct TableScale {
  double least = 0.0, greatest = 0.0;
};
TableScale ScaleToMassTable(const Vehicle& vehicle, int stage, double propellant_kg);
/// Beyond these the masses are another vehicle's.
inline constexpr double kLeastMassScale = 0.5;
inline constexpr double kGreatestMassScale = 2.0;

}  // namespace dispersa
