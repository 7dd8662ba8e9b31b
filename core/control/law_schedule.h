// The law of an axis at a time within a stage, whose numbers change along straight lines (LawPiece).
#pragma once

#include "core/control/law.h"
#include "core/math/row_memory.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// The piece of a law that holds, and the times since ignition in which it does.
template <class T>
struct HeldPiece : LawPieceOf<T> {
  RowRange<T> range;
};
/// The piece of a stage's law at a time. A stage without a schedule is one piece that does not change.
template <class T>
DISPERSA_INLINE void FindPiece(HeldPiece<T>& o, int lane, const AxisLaw& law, int stage,
                               double since_ignition_s) {
  const std::vector<LawPiece>& pieces = law.pieces.data()[stage];
  if (pieces.empty()) {
    o.range.Set(lane, -kNoEnd, kNoEnd);
    Lane(o.from_s, lane) = 0.0;
    SetLane(o.at, lane, law.stages.data()[stage]);
    // Of -0, so that a number keeps its bits, also the sign of a zero.
    for (unsigned i = 0; i < kValues<double, StageLaw>; ++i) SetLaneAt<T>(o.rate, i, lane, -0.0);
    return;
  }
  const LawPiece* const first = pieces.data();
  const LawPiece* const last = first + (pieces.size() - 1);
  const LawPiece* piece = first;
  while (piece != last && since_ignition_s >= piece[1].from_s) ++piece;
  o.range.Set(lane, piece == first ? -kNoEnd : piece->from_s, piece == last ? kNoEnd : piece[1].from_s);
  SetLane<LawPieceOf>(o, lane, *piece);
}

/// The numbers of a law with so many sections at times in the pieces; those of further sections stay.
template <class T>
DISPERSA_INLINE void SetLaw(const LawPieceOf<T>& piece, int sections, T since_ignition_s,
                            StageLawOf<T>& now) {
  const T since = since_ignition_s - piece.from_s;
  const unsigned numbers = kValues<double, StageLaw> - kValues<double, DigitalSection> *
                                                           static_cast<unsigned>(kFilterSections - sections);
  for (unsigned i = 0; i < numbers; ++i)
    SetValueAt(now, i, Fma(since, ValueAt<T>(piece.rate, i), ValueAt<T>(piece.at, i)));
}

/// The law in a stage at a time since its ignition: the same source for a flight's ticks and its margins.
DISPERSA_INLINE StageLaw LawAtTime(const AxisLaw& law, int stage, double since_ignition_s) {
  HeldPiece<double> piece;
  FindPiece(piece, 0, law, stage, since_ignition_s);
  StageLaw now;
  SetLaw(piece, kFilterSections, since_ignition_s, now);
  return now;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
