#include "core/modes/bending_places.h"

#include <algorithm>

namespace dispersa {

PlanePlaces::PlanePlaces(const StackModes& stack, BeamPlane plane, const LoadTable& loads)
    : plane_(plane),
      nodes_m_(stack.station_m[plane == BeamPlane::kY ? 0 : 1]),
      cuts_m_(nodes_m_),
      top_m_(nodes_m_.front()),
      piece_m_((nodes_m_.back() - nodes_m_.front()) / static_cast<double>(kShorteningPieces)) {
  for (std::size_t i = 0; i < kShorteningPieces; ++i)
    pieces_.push_back(PlaceAt(stack, plane, top_m_ + piece_m_ * (static_cast<double>(i) + 0.5)));
  loads.lift.ForEach(
      [&](double station_m) {
        lift_.push_back(PlaceAt(stack, plane, station_m));
        return 0.0;
      },
      [](double, double, double) {});
  cuts_m_.insert(cuts_m_.end(), loads.station_m.begin(), loads.station_m.begin() + loads.stations);
  std::sort(cuts_m_.begin(), cuts_m_.end());
  // Where the points of a mass along the whole beam lie, and bodies that are fixed at a node.
  BeamMasses anywhere;
  anywhere.spread.push_back({nodes_m_.front(), nodes_m_.back(), {1.0, 1.0}, {}});
  for (const double node_m : nodes_m_) anywhere.fixed.push_back({node_m, 1.0, node_m, 0.0});
  for (const MassPoint& m : MassPointsOf(anywhere, cuts_m_))
    known_.push_back({m.fixed_at_m, PlaceAt(stack, plane, m.fixed_at_m), EdgeBefore(m.fixed_at_m)});
}

PieceEdge PlanePlaces::EdgeBefore(double station_m) const {
  const double at = std::clamp((station_m - top_m_) / piece_m_, 0.0, static_cast<double>(kShorteningPieces));
  const std::size_t before = std::min<std::size_t>(static_cast<std::size_t>(at), kShorteningPieces - 1);
  return {before, at - static_cast<double>(before)};
}

std::vector<const MassPlace*> PlanePlaces::Of(const std::vector<MassPoint>& points, const StackModes& stack,
                                              std::deque<MassPlace>& found) const {
  std::vector<const MassPlace*> places(points.size());
  const MassPlace* known = known_.data();
  const MassPlace* const end = known + known_.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double station_m = points[i].fixed_at_m;
    while (known < end && known->station_m < station_m) ++known;
    places[i] = known;
    if (known < end && known->station_m == station_m) continue;
    found.push_back({station_m, PlaceAt(stack, plane_, station_m), EdgeBefore(station_m)});
    places[i] = &found.back();
  }
  return places;
}

BendingPlaces::BendingPlaces(const StackModes& stack, const LoadTable& loads) {
  for (std::size_t p = 0; p < (stack.axisymmetric ? 1u : 2u); ++p)
    planes_.emplace_back(stack, kBeamPlanes[p], loads);
}

bool BendingPlaces::AreOf(const StackModes& stack) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const PlanePlaces& p) { return p.AreOf(stack); });
}

}  // namespace dispersa
