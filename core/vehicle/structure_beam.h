// The vehicle as an elastic beam on its axis, as its file describes it: plain data in SI units.
//
// Stations as in vehicle.h. Its masses are those of the mass model of vehicle.h (structure and grains). A
// stage that gives its own mass per length uses it, scaled to the same mass, centre of gravity and inertia.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/input/fields.h"

namespace dispersa {

/// Lateral planes of bending, by the body axis along which the beam moves.
enum class BeamPlane { kY, kZ };
inline constexpr std::array<BeamPlane, 2> kBeamPlanes = {BeamPlane::kY, BeamPlane::kZ};

/// A value at the top and at the bottom of a section, linear between.
struct Taper {
  double top = 0.0;
  double bottom = 0.0;
  double At(double fraction) const { return top + fraction * (bottom - top); }
};

/// A length of the load-carrying structure. Its stiffness is either given or a round tube's: of a modulus
/// above 0.
struct BeamSection {
  std::string name;
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  Taper bending_stiffness_n_m2;  ///< in plane y
  Taper shear_stiffness_n;       ///< kappa G A in plane y (0: no shear, as without Timoshenko's theory)
  Taper outer_diameter_m;
  Taper thickness_m;
  double modulus_pa = 0.0;        ///< E of the tube (0: the stiffness is given)
  double poisson_ratio = 0.0;     ///< of the tube
  double z_to_y_stiffness = 1.0;  ///< stiffness in plane z over that in plane y, in bending and shear
  Taper mass_per_length_kg_m;     ///< of a stage that gives its own masses

  double BendingStiffness(BeamPlane plane, double station_m) const;
  /// 0: does not shear. A thin round tube's coefficient is 2 (1 + nu) / (4 + 3 nu) (Cowper, J. Appl. Mech.
  /// 33, 1966).
  double ShearStiffness(BeamPlane plane, double station_m) const;
};

void Describe(Fields& fields, BeamSection& section, bool timoshenko);

/// A body that does not bend, fixed to the beam at one station: a payload on its adapter, nozzles on a dome.
struct LumpedMass {
  std::string name;
  double station_m = 0.0;
  std::string element;  ///< empty: the values below
  double mass_kg = 0.0;
  double cg_station_m = 0.0;
  double inertia_kg_m2 = 0.0;
};

/// A stage's part of the beam. It flies as long as the stage is attached. Where sections of several stages
/// overlap, their stiffnesses add.
struct BeamStage {
  std::vector<BeamSection> sections;
  std::vector<LumpedMass> lumped_masses;
  bool own_masses = false;  ///< mass per length and lumped masses are given, not the mass model's
};

/// A place whose deflection and slope are wanted.
struct BeamSensor {
  std::string name;
  double station_m = 0.0;
};

inline void Describe(Fields& fields, BeamSensor& sensor) {
  fields.Text("name", sensor.name, "as `dispersa modes` lists it");
  fields.Quantity("station", kLength, kNonNegative, sensor.station_m, "station of the sensor");
}

/// A mode of a finite-element model, at one propellant level of one stack.
struct TabledMode {
  int stage = 0;  ///< the stack's lowest, from 0
  double propellant_kg = 0.0;
  BeamPlane plane = BeamPlane::kY;
  int mode = 0;  ///< from 1, not necessarily the same mode from level to level
  double frequency_rad_s = 0.0;
  double generalized_mass_kg = 0.0;
  std::vector<double> station_m;  ///< increasing
  std::vector<double> deflection;
  std::vector<double> slope_1_m;  ///< by the station
};

/// Modes that fly in one plane at most.
inline constexpr int kMostFlownModes = 5;

struct StructureBeam {
  bool timoshenko = false;
  bool rotary_inertia = true;
  int modes = 3;
  int propellant_levels = 11;
  int elements = 40;
  int flown_modes = 3;
  double damping_ratio = 0.01;
  std::vector<BeamSensor> sensors;
  std::vector<BeamStage> stages;  ///< as the vehicle's; a restart has its stage's (none with a table)
  std::vector<TabledMode> table;  ///< by stage, falling propellant, plane and mode (none with stages)
};

/// The keys of the beam of a vehicle of `stages` stages, `bodies` of which are no restart (0: unknown).
void Describe(Fields& fields, StructureBeam& beam, std::size_t stages, std::size_t bodies);

struct Vehicle;

/// Contradictions in the beam, or with the vehicle's mass model. Paths are `structure_beam.…`. Precondition:
/// the vehicle has a beam and no other problems.
std::vector<StructProblem> BeamProblems(const Vehicle& vehicle);

}  // namespace dispersa
