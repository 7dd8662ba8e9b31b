// The places of a stack's beam at which a bending table looks at its modes. They are the same for all masses
// and levels, so they are found once.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "core/modes/load_table.h"
#include "core/structure/bending_modes.h"
#include "core/structure/mass_points.h"
#include "core/structure/node_masses.h"

namespace dispersa {

/// The deflections and slopes of four modes at a place.
struct FourStations {
  FourShapes deflection, slope_1_m;
};
/// A place's values in four modes, in the order in which BeamPlace::Of() adds them for one.
inline FourStations FourAt(const BeamPlace& place, const FourShapes* modes) {
  const FourShapes* const rows = modes + kNodeRows * place.node;
  FourStations at{0.0, 0.0};
  for (std::size_t k = 0; k < kElementRows; ++k) {
    at.deflection = at.deflection + FourShapes(place.deflection[k]) * rows[k];
    at.slope_1_m = at.slope_1_m + FourShapes(place.rotation[k]) * rows[k];
  }
  return at;
}

/// Pieces of the beam in which the shortening is summed.
inline constexpr std::size_t kShorteningPieces = 400;

/// A place between the edges of even pieces of the beam, from the nose aft.
struct PieceEdge {
  std::size_t before = 0;
  double part = 0.0;  ///< of the piece behind it
};

/// A place at which a mass is fixed.
struct MassPlace {
  double station_m = 0.0;
  BeamPlace place;
  PieceEdge edge;
};

/// Of one plane.
class PlanePlaces {
 public:
  PlanePlaces(const StackModes& stack, BeamPlane plane, const LoadTable& loads);

  double piece_m() const { return piece_m_; }
  /// The middles of the pieces.
  const std::vector<BeamPlace>& pieces() const { return pieces_; }
  /// In the order in which LiftDistribution asks for incidences: the middle of a piece is at MiddleOf().
  const std::vector<BeamPlace>& lift() const { return lift_; }
  static std::size_t MiddleOf(std::size_t lift_piece) { return 2 * lift_piece + 2; }
  /// At which the points of a mass are cut: the nodes and the load stations, rising.
  const std::vector<double>& cuts_m() const { return cuts_m_; }
  /// Of points, whose stations rise. `found` takes those that are not known beforehand.
  std::vector<const MassPlace*> Of(const std::vector<MassPoint>& points, const StackModes& stack,
                                   std::deque<MassPlace>& found) const;
  PieceEdge EdgeBefore(double station_m) const;
  bool AreOf(const StackModes& stack) const {
    return stack.station_m[plane_ == BeamPlane::kY ? 0 : 1] == nodes_m_;
  }

 private:
  BeamPlane plane_;
  std::vector<double> nodes_m_, cuts_m_;
  double top_m_ = 0.0, piece_m_ = 0.0;
  std::vector<BeamPlace> pieces_, lift_;
  std::vector<MassPlace> known_;  ///< rising
};

class BendingPlaces {
 public:
  BendingPlaces(const StackModes& stack, const LoadTable& loads);
  const PlanePlaces& Of(std::size_t plane) const { return planes_[plane]; }
  bool AreOf(const StackModes& stack) const;

 private:
  std::vector<PlanePlaces> planes_;
};

}  // namespace dispersa
