// Bending of one stack as a flight needs it: a row a mode over the propellant, at the places where forces
// act and sensors sit. Plain data, for dynamics/bending.h; the modes themselves are bending_modes.h's.
#pragma once

#include <array>
#include <vector>

#include "core/math/aligned_rows.h"
#include "core/structure/bending_modes.h"
#include "core/structure/load_table.h"

namespace dispersa {

/// Modes that fly in one plane at most.
inline constexpr int kModes = kMostFlownModes;
inline constexpr int kPlanes = 2;

struct BendingTable {
  /// Frequency (rad/s), 1 / generalised mass; at the pivot: deflection, slope; slopes at the inertial unit
  /// and at each rate gyro; shortening with each mode; from kStripsAt deflection, then slope of each strip;
  /// from kMomentAt the bending moment of the mode's inertia at each load station, for a unit acceleration of
  /// it.
  enum Column : int {
    kFrequency = 0,
    kInverseMass = 1,
    kPivotDeflection = 2,
    kPivotSlope = 3,
    kUnitSlope = 4,
    kGyroSlope = 5,
    kShortening = 8,
    kStripsAt = 16,
    kMomentAt = 32,
    kRowSize = 40
  };
  static_assert(kGyroSlope + kRateGyros == kShortening && kShortening + kModes <= kStripsAt &&
                kStripsAt + 2 * kStrips == kMomentAt && kMomentAt + kLoadStations <= kRowSize);

  int modes = 0;                      ///< that fly, in each plane
  int planes = 1;                     ///< 1: plane z is plane y
  std::vector<double> propellant_kg;  ///< of the levels, falling
  AlignedRows rows;                   ///< by plane, level, mode; linear between levels, held beyond

  /// A column at a propellant, for what is not flown.
  double At(int plane, int mode, int column, double propellant_kg) const;

  const double* Row(int plane, int level, int mode) const {
    const int levels = static_cast<int>(propellant_kg.size());
    return rows.data() + kRowSize * ((plane * levels + level) * modes + mode);
  }
};

/// Modes of a stack that fly: only those whose frequency stays below `highest_rad_s` all the burn, and no
/// more than the beam's flown_modes: of the rest none, from the first on that does not.
int ModesBelow(const Vehicle& vehicle, const StackModes& stack, double highest_rad_s);

/// The table of the first `modes` modes of one stack.
///
/// `shortening` of modes j and k: the integral of w_j' w_k' over the beam, weighted with the share of the
/// mass that lies ahead. The axial force F carried by the stack lowers the stiffness by F times that (the
/// potential energy of a compressed beam, e.g. S. Timoshenko and J. Gere, "Theory of Elastic
/// Stability", 1.11; drag taken as carried like thrust).
BendingTable BuildBendingTable(const Vehicle& vehicle, const StackModes& stack, const LoadTable& loads,
                               int modes);

}  // namespace dispersa
