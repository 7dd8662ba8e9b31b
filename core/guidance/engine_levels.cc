#include "core/guidance/engine_levels.h"

#include <algorithm>

#include "core/math/functions.h"

namespace dispersa {

EngineLevels::EngineLevels(const Throttle& throttle) {
  if (throttle.empty()) {
    pieces_.push_back({0.0, 1.0, 0.0, 0.0});
    return;
  }
  double sum_s = 0.0;
  for (std::size_t i = 0; i + 1 < throttle.time_s.size(); ++i) {
    const double length_s = throttle.time_s[i + 1] - throttle.time_s[i];
    pieces_.push_back({throttle.time_s[i], throttle.level[i],
                       (throttle.level[i + 1] - throttle.level[i]) / length_s, sum_s});
    sum_s += 0.5 * (throttle.level[i] + throttle.level[i + 1]) * length_s;
  }
  pieces_.push_back({throttle.time_s.back(), throttle.level.back(), 0.0, sum_s});
  bends_s_.assign(throttle.time_s.begin() + 1, throttle.time_s.end());
}

const EngineLevels::Piece& EngineLevels::PieceAt(double since_ignition_s) const {
  std::size_t i = pieces_.size() - 1;
  while (i > 0 && pieces_[i].begin_s > since_ignition_s) --i;
  return pieces_[i];
}

double EngineLevels::At(double since_ignition_s) const {
  const Piece& piece = PieceAt(since_ignition_s);
  return std::max(piece.level + piece.slope_1_s * (since_ignition_s - piece.begin_s), 0.0);
}

double EngineLevels::Sum(double since_ignition_s) const {
  const Piece& piece = PieceAt(since_ignition_s);
  const double since_s = since_ignition_s - piece.begin_s;
  return piece.sum_s + since_s * (piece.level + 0.5 * piece.slope_1_s * since_s);
}

double EngineLevels::TimeOf(double sum_s) const {
  if (!(sum_s > 0.0)) return 0.0;
  std::size_t i = pieces_.size() - 1;
  while (i > 0 && pieces_[i].sum_s >= sum_s) --i;
  const Piece& piece = pieces_[i];
  const double wanted_s = sum_s - piece.sum_s;
  const double root2 = piece.level * piece.level + 2.0 * piece.slope_1_s * wanted_s;
  const double divisor = piece.level + Sqrt(root2 > 0.0 ? root2 : 0.0);
  return divisor > 0.0 ? piece.begin_s + 2.0 * wanted_s / divisor : piece.begin_s;
}

}  // namespace dispersa
