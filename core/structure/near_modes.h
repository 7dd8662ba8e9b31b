// Modes of drawn masses, near the nominal modes of the same beam.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/structure/bending_mode.h"
#include "core/structure/bending_modes.h"
#include "core/structure/free_free_modes.h"
#include "core/structure/mode_tracking.h"
#include "core/structure/node_masses.h"

namespace dispersa {

/// Modes as combinations of shapes, by rising frequency.
struct RitzModes {
  Eigen::VectorXd stiffness;  ///< frequency squared
  Eigen::MatrixXd share;      ///< of the shapes; a column a mode of unit mass
};

/// The beam of a stack in one plane, with its nominal modes at each propellant level.
///
/// Subspace iteration from the nominal modes (K. J. Bathe, E. L. Wilson, Solution methods for eigenvalue
/// problems in structural mechanics, Int. J. Numer. Methods Eng. 6, 1973). The inertia of the shapes bends
/// the free beam into new shapes. Among these the method of Rayleigh and Ritz finds the modes. A free beam is
/// statically determinate, so no system of equations is solved (SolveFreeFree). One turn multiplies the error
/// of a shape by (its frequency / that of the first mode beyond the shapes)². It is repeated until the error
/// left in each mode, by this ratio and the change of the last turn, is below kShapeError.
class NearModes {
 public:
  /// Estimated error of a shape, as the root of the generalised mass of what is wrong over that of the mode.
  static constexpr double kShapeError = 5e-5;
  /// By how much the last turn of Lowest() may change a shape, in the same sense: a frequency is then right
  /// to rounding.
  static constexpr double kWholeChange = 3e-7;

  NearModes(std::vector<double> stations, std::vector<BeamElement> elements, bool rotary_inertia);

  /// The `count` lowest elastic modes, as SolveFreeFree() gives them: by the same iteration from cosines
  /// along the beam, in a tenth of the time. Where it does not converge, SolveFreeFree() takes its place.
  FreeFreeModes Lowest(const BeamMasses& masses, int count) const;

  /// Number of nominal modes that AddLevel takes, for so many `modes` that are sought.
  static int ShapesFor(int modes);
  /// The nominal modes of the next level, with unit modal masses. Those that are sought come first, in their
  /// order and with their signs.
  void AddLevel(const FreeFreeModes& nominal);

  /// The first `count` modes with other masses at a level, in the order of the nominal ones and with their
  /// signs, scaled to a largest deflection of 1. `mac` is that with the nominal mode. Nothing where one of
  /// them resembles its nominal mode by less than `least_mac`, or the iteration does not converge.
  std::optional<std::vector<BendingMode>> Find(std::size_t level, const BeamMasses& masses, int count,
                                               double least_mac) const;

  /// What 1 N at a place, and 1 N m there, bend the beam of these masses by when its rigid motion is taken
  /// from it.
  std::array<BentShape, 2> ByLoadsAt(const BeamPlace& place, const BeamMasses& masses) const;

  const std::vector<double>& stations() const { return masses_.stations(); }

 private:
  struct Level {
    ShapeColumns shapes;
    Eigen::VectorXd stiffness;  ///< by mode: its frequency squared
  };
  ShapeColumns Bent(const ShapeColumns& loads) const;

  NodeMassMaker masses_;
  bool rotary_inertia_;
  /// By element: of its ends' rotations and its bow, 11, 12, 13, 22, 23, 33.
  std::vector<std::array<double, 6>> flexibility_;
  std::vector<double> arms_m_;  ///< of the nodes from the middle of the beam
  std::vector<Level> levels_;
};

/// Of a stack, by plane (null: as plane y, or too coarse a mesh).
struct ModeBasis {
  std::array<std::unique_ptr<const NearModes>, 2> planes;
};

}  // namespace dispersa
