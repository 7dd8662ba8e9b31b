// Bending modes of a vehicle: of each stack, over its propellant.
//
// A mode q of frequency omega and generalised mass m has the lateral displacement deflection(s) q along body
// y or z at station s, q in metres. Shapes are scaled to a largest deflection of 1. At lift-off of the stack
// the nose end points along +y or +z, and from level to level a mode keeps its sign. `slope` is the rotation
// of the cross-section over the station (aft): a unit q turns the body by +slope about y in plane z, and by
// -slope about z in plane y.
//
// In flight q'' + 2 zeta omega q' + omega² q = (sum of force deflection + moment slope) / m at the actual
// propellant, with all values linear between levels. Along() tables the values of one place.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/structure/beam_elements.h"
#include "core/structure/bending_mode.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// The modes of one plane at one propellant level. A mode has the same index at all levels.
struct BendingLevel {
  double propellant_kg = 0.0;
  std::vector<BendingMode> modes;
  /// The free beam under a steady force of 1 N at the nozzle pivot, and under a couple of 1 N m there, in
  /// mean axes: m and rad (empty: the modes come from a table).
  std::array<BentShape, 2> by_pivot_load{};
};

struct ModeBasis;  ///< near_modes.h

struct StackModes {
  int stage = 0;                                    ///< the stack's lowest, from 0
  unsigned gone = 0;                                ///< without these jettisoned bodies (BuildBeamMasses)
  bool axisymmetric = true;                         ///< plane z is plane y
  std::array<std::vector<double>, 2> station_m;     ///< of the nodes, by plane
  std::array<std::vector<double>, 2> shear_ratio;   ///< of the elements between them
  std::array<double, 2> mesh_difference{};          ///< of elements twice as long (beam_mesh.h), by plane
  std::array<std::vector<BendingLevel>, 2> levels;  ///< by plane, in order of falling propellant
  /// For the modes of other masses (null: the modes come from a table, or are of other masses themselves).
  std::shared_ptr<const ModeBasis> basis;
};

/// Shape at a station. Beyond the ends of the beam it goes on straight.
struct StationShape {
  double deflection = 0.0;
  double slope_1_m = 0.0;
};
/// A station of the beam, found once for all modes and levels: its element, and the shares of what the
/// element's two nodes and its bow do.
struct BeamPlace {
  std::size_t node = 0;
  std::array<double, kElementRows> deflection{}, rotation{};

  StationShape Of(const BentShape& mode) const {
    const double rows[kElementRows] = {mode.deflection[node], mode.slope_1_m[node], mode.bow[node],
                                       mode.deflection[node + 1], mode.slope_1_m[node + 1]};
    StationShape at;
    for (std::size_t k = 0; k < kElementRows; ++k) {
      at.deflection += deflection[k] * rows[k];
      at.slope_1_m += rotation[k] * rows[k];
    }
    return at;
  }
};
BeamPlace PlaceAt(const StackModes& stack, BeamPlane plane, double station_m);
StationShape ShapeOf(const StackModes& stack, BeamPlane plane, const BentShape& shape, double station_m);

/// The modes of the stack of a stage that is no restart.
///
/// A stack with boosters has its levels over their burn, with the propellant that they have at each
/// (booster_course.h). The last level lies behind their separation.
///
/// Further levels are added between those of the file where a mode changes so much that its modal assurance
/// criterion falls below 0.9, down to 1/32 of a step. Precondition: a vehicle with a beam and without
/// Problems(). A table's shapes and generalised masses are scaled as above. Its modes are tracked in the same
/// way, with the vehicle's mass model as weight. Then nothing is jettisoned (`gone` 0).
StackModes BuildStackModes(const Vehicle& vehicle, int stage, unsigned gone = 0);
/// The first `modes` modes of the same stack of a vehicle with other masses than the nominal ones, which
/// `nominal` has. They are sought near these, on the same mesh (near_modes.h). If one does not resemble its
/// nominal mode, all are solved as a whole.
StackModes BuildStackModesNear(const Vehicle& vehicle, const StackModes& nominal, int modes);
/// The modes that pages show: of each stage that is no restart with all its bodies, then without boosters,
/// then without all that it jettisons.
std::vector<StackModes> ShownStacks(const Vehicle& vehicle);
/// "", or ", without fairing": what has left.
std::string WithoutText(const Vehicle& vehicle, const StackModes& stack);
/// One for each stage, with all bodies that it carries at lift-off. A restart has the modes of its stage.
std::vector<StackModes> BuildBendingModes(const Vehicle& vehicle);

/// A mode of one plane at a place over the propellant, for a flight: falling propellant, as the levels.
struct ModeAlong {
  std::vector<double> propellant_kg, frequency_rad_s, generalized_mass_kg, deflection, slope_1_m;
};
ModeAlong Along(const StackModes& stack, BeamPlane plane, int mode, double station_m);

/// Stations that pages show: the beam's sensors and the stack's nozzle pivot.
std::vector<BeamSensor> ShownStations(const Vehicle& vehicle, int stage);

}  // namespace dispersa
