// The distribution of the normal force along the body.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// A short length of the body, between two cross-sections.
struct LiftPiece {
  double from_m = 0.0, to_m = 0.0;        ///< stations
  double area_from = 0.0, area_to = 0.0;  ///< of the cross-sections, of the base's
  double shift_1_m = 0.0;

  double Middle() const { return 0.5 * (from_m + to_m); }
};

/// The normal force of a stack along its body. By slender-body theory a piece has the share area_to -
/// area_from (2 dA/dx; Munk, NACA TR 184). To this it adds `shift` times the distance (m) of the centre of
/// pressure aft of slender_station_m. `shift` is proportional to the planform and to the distance from its
/// centroid. All shares together are then 1, and their centroid is the centre of pressure.
struct LiftDistribution {
  std::vector<LiftPiece> pieces;  ///< from the nose aft
  double slender_station_m = 0.0;

  /// The effect of an incidence that varies along the body. In slender-body theory the momentum of the
  /// cross-flow per length is A alpha. A piece of the body gets its increase, d(A alpha). A curved body
  /// therefore has lift even where its cross-section does not grow. The share of `shift` sees the incidence
  /// at its place. `incidence_at` gives the incidence at a station, or those of several modes side by side.
  /// `take` receives each piece's middle, and its force for a slope of 1 and for a shift of 1 m.
  template <typename Incidence, typename Take>
  void ForEach(const Incidence& incidence_at, const Take& take) const {
    if (pieces.empty()) return;
    auto before = pieces.front().area_from * incidence_at(pieces.front().from_m);
    for (const LiftPiece& piece : pieces) {
      const auto after = piece.area_to * incidence_at(piece.to_m);
      take(piece.Middle(), after - before, piece.shift_1_m * incidence_at(piece.Middle()));
      before = after;
    }
  }
};

/// Pieces of a section of the mould line, and of an eighth of the stack's length, at least. Twice as many
/// quarter the error; with these it is 0.03 % of the greatest force of its kind, over modes and propellant,
/// on SLV-4 (modes_lift_distribution_test).
inline constexpr int kLiftPieces = 32;

/// The distribution for the stack of stages `stage` (from 0) and above. No piece lies on both sides of one of
/// `cuts_m`. Precondition: a profile that reaches the stage's bottom.
LiftDistribution DistributeLift(const Vehicle& vehicle, int stage, const std::vector<double>& cuts_m = {},
                                int pieces = kLiftPieces);

}  // namespace dispersa
