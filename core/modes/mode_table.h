// The modes of one stack for flights: for each a row over the propellant, at the places of forces and
// sensors. Plain data for dynamics/bending.h. Its rows come from one source of modes (beam_table.h) or from
// several (flown_modes.h).
#pragma once

#include <array>
#include <vector>

#include "core/math/aligned_rows.h"
#include "core/modes/load_table.h"
#include "core/vehicle/structure_beam.h"

namespace dispersa {

/// Largest number of modes that fly in one plane.
inline constexpr int kModes = kMostFlownModes;
inline constexpr int kPlanes = 2;

/// Effects of a distributed force: the force, its moment about the nose tip (its sum times the station), and
/// its work on each mode. From kSectionEffects on: the moment about each load station of the force ahead of
/// it.
enum LiftEffect : int {
  kForceEffect = 0,
  kFirstEffect = 1,
  kWorkEffects = 2,
  kSectionEffects = kWorkEffects + kModes,
  kLiftEffects = kSectionEffects + kLoadStations
};
/// Causes of the lift. The slope of a mode is an incidence, and so is its rate over the airspeed. Each acts
/// by slender-body theory, and in proportion to the shift of the centre of pressure aft of it
/// (lift_distribution.h).
enum LiftCause : int { kSlopeSlender, kSlopeShift, kRateSlender, kRateShift, kLiftCauses };

/// Factors of one flight on every stack's bending.
template <class T>
struct BendingFactorsOf {
  std::array<T, kModes> frequency_factor{T(1.0), T(1.0), T(1.0), T(1.0), T(1.0)};  ///< of each mode
  T damping_factor = T(1.0);                                                       ///< of every mode's ratio
  T slope_factor = T(1.0);  ///< of the slopes that sensors feel
};
using BendingFactors = BendingFactorsOf<double>;

struct ModeTable {
  /// Columns. Frequency (rad/s), 1 / generalised mass and damping ratio. At the pivot: deflection and slope.
  /// Slopes at the inertial unit and at each rate gyro. Shortening with each mode: by how much a newton along
  /// the axis lowers the stiffness. Work on the mode of the straight body's lift, by slender-body theory and
  /// by shift.
  ///
  /// From kLiftAt on: effects of the lift by a unit of the mode, by cause and effect, for a normal force of 1
  /// per radian. These are the columns of each step. If there is a stage above: mean displacement of its
  /// centre of gravity, and mean rotation, for a unit of the mode. If there are boosters: deflection at the
  /// station of their nozzles and slope, both of their rigid link, and the shortening of the beam behind the
  /// link with each mode. From kMomentAt on the bending moment of the mode's inertia about each load station,
  /// for a unit acceleration of the mode, and from kSectionsAt on the effects of the lift about each.
  ///
  /// Of the first mode's row alone, residual flexibility at the pivot: what a steady load there moves it by
  /// beyond the modes that fly. Deflection by a force (m/N), slope by a force, which is deflection by a
  /// couple (rad/N, 1/N), and slope by a couple (rad/(N m)).
  enum Column : int {
    kFrequency = 0,
    kInverseMass = 1,
    kPivotDeflection = 2,
    kPivotSlope = 3,
    kUnitSlope = 4,
    kGyroSlope = 5,
    kShortening = 8,
    kStraightLift = 13,
    kUpperShift = 15,
    kLiftAt = 16,
    kUpperTurn = 44,
    kBoosterDeflection = 45,
    kBoosterSlope = 46,
    kBehindBoosters = 47,
    kResidual = 52,
    kDamping = 55,
    kMomentAt = 56,
    kSectionsAt = kMomentAt + kLoadStations,
    kRowSize = kSectionsAt + int{kLiftCauses} * kLoadStations
  };
  static_assert(kGyroSlope + kRateGyros == kShortening && kShortening + kModes == kStraightLift &&
                kLiftAt + int{kLiftCauses} * int{kSectionEffects} == kUpperTurn &&
                kBehindBoosters + kModes == kResidual && kResidual + 3 == kDamping && kDamping < kMomentAt &&
                kRowSize % 4 == 0);
  static constexpr int LiftColumn(int cause, int effect) {
    return effect < kSectionEffects ? kLiftAt + kSectionEffects * cause + effect
                                    : kSectionsAt + kLoadStations * cause + effect - kSectionEffects;
  }

  int modes = 0;                      ///< that fly, in each plane
  int planes = 1;                     ///< 1: plane z is plane y
  std::vector<double> propellant_kg;  ///< of the levels, falling
  AlignedRows rows;                   ///< by plane, level, mode; linear between levels, held beyond

  /// A column at a propellant, for uses outside flights.
  double At(int plane, int mode, int column, double propellant_kg) const;

  const double* Row(int plane, int level, int mode) const {
    const int levels = static_cast<int>(propellant_kg.size());
    return rows.data() + kRowSize * ((plane * levels + level) * modes + mode);
  }
};

}  // namespace dispersa
