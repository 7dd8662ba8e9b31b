#include "core/modes/lift_distribution.h"

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/vehicle/mould_line.h"

namespace dispersa {

LiftDistribution DistributeLift(const Vehicle& vehicle, int stage, const std::vector<double>& cuts_m,
                                int pieces) {
  DISPERSA_ASSERT(stage >= 0 && stage < std::ssize(vehicle.stages) && pieces > 0, stage, pieces);
  const double bottom_m = vehicle.stages[static_cast<std::size_t>(stage)].bottom_station_m;
  const std::vector<MouldSection> body = CutMouldLine(vehicle.profile, bottom_m);
  // Sums of lengths in a file have rounding.
  DISPERSA_ASSERT(body.back().end_m > bottom_m - 1e-3, body.back().end_m, bottom_m);
  const double base2 = Square(body.back().aft_radius_m);
  LiftDistribution lift;
  double planform = 0.0, planform_moment = 0.0, area = 0.0;
  for (const MouldSection& section : body) {
    std::vector<double> edges = {section.start_m, section.end_m};
    for (const double cut : cuts_m)
      if (cut > section.start_m && cut < section.end_m) edges.push_back(cut);
    std::sort(edges.begin(), edges.end());
    const double longest_m = std::min(section.end_m - section.start_m, bottom_m / 8.0) / pieces;
    for (std::size_t edge = 1; edge < edges.size(); ++edge) {
      const double length_m = edges[edge] - edges[edge - 1];
      const int count = std::max(static_cast<int>(std::ceil(length_m / longest_m - 1e-9)), 1);
      const double step = length_m / count;
      for (int i = 0; i < count; ++i) {
        LiftPiece piece;
        piece.from_m = edges[edge - 1] + step * i;
        piece.to_m = i + 1 < count ? piece.from_m + step : edges[edge];
        piece.area_from = area;
        piece.area_to = area = Square(section.Radius(piece.to_m)) / base2;
        const double side = section.Radius(piece.Middle()) * (piece.to_m - piece.from_m);
        piece.shift_1_m = side;
        planform += side;
        planform_moment += side * piece.Middle();
        lift.slender_station_m += (piece.area_to - piece.area_from) * piece.Middle();
        lift.pieces.push_back(piece);
      }
    }
  }
  const double centroid_m = planform_moment / planform;
  double spread = 0.0;
  for (LiftPiece& piece : lift.pieces) {
    piece.shift_1_m *= piece.Middle() - centroid_m;
    spread += piece.shift_1_m * piece.Middle();
  }
  for (LiftPiece& piece : lift.pieces) piece.shift_1_m /= spread;
  return lift;
}

}  // namespace dispersa
