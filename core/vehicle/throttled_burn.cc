#include "core/vehicle/throttled_burn.h"

#include <algorithm>
#include <cmath>

namespace dispersa {
namespace {

constexpr double kNever_s = HUGE_VAL;

// The level from a time on, until `end_s`.
struct Piece {
  double begin_s, level, slope_1_s, end_s;
};

// The last one ends where the throttle has come to 0, else never.
std::vector<Piece> PiecesOf(const Throttle& throttle) {
  if (throttle.empty()) return {{0.0, 1.0, 0.0, kNever_s}};
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < throttle.time_s.size(); ++i) {
    const double length_s = throttle.time_s[i + 1] - throttle.time_s[i];
    pieces.push_back({throttle.time_s[i], throttle.level[i],
                      (throttle.level[i + 1] - throttle.level[i]) / length_s, throttle.time_s[i + 1]});
  }
  if (throttle.level.back() > 0.0)
    pieces.push_back({throttle.time_s.back(), throttle.level.back(), 0.0, kNever_s});
  return pieces;
}

// In units of full flow times seconds: what a piece burns in its first `since_s`.
double BurntBy(const Piece& piece, double since_s) {
  return since_s * (piece.level + 0.5 * piece.slope_1_s * since_s);
}

// The time from a piece's begin in which it burns `wanted_s`, which it does.
double TimeToBurn(const Piece& piece, double wanted_s) {
  const double root2 = piece.level * piece.level + 2.0 * piece.slope_1_s * wanted_s;
  return 2.0 * wanted_s / (piece.level + std::sqrt(std::max(root2, 0.0)));
}

// Up to a command, and the decay after it.
void Cut(const CutOffCommand& command, std::vector<Piece>& pieces) {
  while (pieces.size() > 1 && pieces.back().begin_s >= command.at_s) pieces.pop_back();
  Piece& last = pieces.back();
  if (command.at_s >= last.end_s) return;
  last.end_s = command.at_s;
  const double level = last.level + last.slope_1_s * (last.end_s - last.begin_s);
  if (command.tail_off_s > 0.0 && level > 0.0)
    pieces.push_back({command.at_s, level, -level / command.tail_off_s, command.at_s + command.tail_off_s});
}

}  // namespace

ThrottledBurn Throttled(const Throttle& throttle, const Supply& supply, const CutOffCommand& command) {
  const auto& [propellant_kg, residual_kg, full_flow_kg_s] = supply;
  const double usable_s = std::max(propellant_kg - residual_kg, 0.0) / full_flow_kg_s;
  ThrottledBurn burn;
  double burnt_s = 0.0;  // at full flow
  bool ended = false;
  std::vector<Piece> pieces = PiecesOf(throttle);
  Cut(command, pieces);
  for (std::size_t i = 0; i < pieces.size() && !ended; ++i) {
    const Piece& piece = pieces[i];
    double end_s = piece.end_s;
    const double rest_s = usable_s - burnt_s;
    const bool depletes = end_s == kNever_s || BurntBy(piece, end_s - piece.begin_s) >= rest_s;
    if (depletes) end_s = piece.begin_s + TimeToBurn(piece, rest_s);
    ended = depletes || i + 1 == pieces.size();
    const double length_s = end_s - piece.begin_s;
    const double burnt_then_s = burnt_s + BurntBy(piece, length_s);
    if (ended) {
      burn.left_kg =
          depletes ? std::min(residual_kg, propellant_kg) : propellant_kg - full_flow_kg_s * burnt_then_s;
      burn.curve.end_s = end_s;
    }
    const double level = ended ? piece.level + piece.slope_1_s * length_s : piece.level;
    const double whole_kg = propellant_kg > 0.0 ? propellant_kg : 1.0;  // of a restart with nothing left
    const double left = ended ? burn.left_kg / whole_kg : 1.0 - burnt_s * full_flow_kg_s / whole_kg;
    burn.curve.begin_s.push_back(piece.begin_s);
    burn.curve.rows.insert(burn.curve.rows.end(), {ended ? end_s : piece.begin_s, level, piece.slope_1_s,
                                                   left, level, piece.slope_1_s, 0.0, 0.0});
    burnt_s = burnt_then_s;
  }
  return burn;
}

}  // namespace dispersa
