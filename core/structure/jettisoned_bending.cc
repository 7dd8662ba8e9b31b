#include "core/structure/jettisoned_bending.h"

#include <algorithm>
#include <utility>

#include "core/structure/free_body.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

// A mode between two levels of the table: the shapes are linear between them, and held beyond.
class ModeAt {
 public:
  ModeAt(const StackModes& stack, std::size_t plane, int mode, double propellant_kg)
      : stack_(stack), plane_(kBeamPlanes[plane]), mode_(static_cast<std::size_t>(mode)) {
    const std::vector<BendingLevel>& levels = stack.levels[plane];
    std::size_t at = 0;
    while (at + 2 < levels.size() && propellant_kg < levels[at + 1].propellant_kg) ++at;
    low_ = &levels[at].modes[mode_];
    high_ = &levels[std::min(at + 1, levels.size() - 1)].modes[mode_];
    if (low_ != high_)
      within_ = std::clamp((levels[at].propellant_kg - propellant_kg) /
                               (levels[at].propellant_kg - levels[at + 1].propellant_kg),
                           0.0, 1.0);
  }
  StationShape operator()(const MassPoint& m, std::size_t) const {
    const double station_m = m.fixed_at_m;
    const StationShape a = ShapeOf(stack_, plane_, *low_, station_m),
                       b = ShapeOf(stack_, plane_, *high_, station_m);
    return {a.deflection + within_ * (b.deflection - a.deflection),
            a.slope_1_m + within_ * (b.slope_1_m - a.slope_1_m)};
  }

 private:
  const StackModes& stack_;
  BeamPlane plane_;
  std::size_t mode_;
  const BendingMode *low_, *high_;
  double within_ = 0.0;
};

}  // namespace

JettisonedBending::JettisonedBending(std::shared_ptr<const Vehicle> vehicle,
                                     std::shared_ptr<const StackModes> whole,
                                     std::shared_ptr<const BendingTable> table,
                                     std::shared_ptr<const LoadTable> loads,
                                     std::shared_ptr<const JettisonedBending> near)
    : vehicle_(std::move(vehicle)),
      stage_(whole->stage),
      loads_(std::move(loads)),
      near_(std::move(near)),
      modes_(table->modes),
      carried_(CarriedBy(*vehicle_, stage_)) {
  made_[0] = std::make_unique<const Lighter>(Lighter{std::move(whole), std::move(table)});
}

const BendingTable& JettisonedBending::Without(unsigned gone) const { return *Of(gone).table; }

const JettisonedBending::Lighter& JettisonedBending::Of(unsigned gone) const {
  gone &= carried_;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<const Lighter>& made = made_[gone];
  if (!made) {
    const StackModes* const near = near_ ? near_->Of(gone).modes.get() : nullptr;
    auto modes = std::make_shared<const StackModes>(BuildStackModes(*vehicle_, stage_, gone, near));
    auto table = std::make_shared<const BendingTable>(BuildBendingTable(*vehicle_, *modes, *loads_, modes_));
    made = std::make_unique<const Lighter>(Lighter{std::move(modes), std::move(table)});
  }
  return *made;
}

ModalPassage JettisonedBending::Passage(unsigned before, unsigned after, double propellant_kg) const {
  const Lighter &from = Of(before), &to = Of(after);
  const FreeBody rest(BuildBeamMasses(*vehicle_, stage_, propellant_kg, after & carried_),
                      from.modes->station_m[0]);
  ModalPassage passage;
  for (std::size_t plane = 0; plane < kPlanes; ++plane)
    for (int old = 0; old < modes_; ++old) {
      const std::size_t k = static_cast<std::size_t>(old);
      const ModeAt flown(*from.modes, plane, old, propellant_kg);
      const StationShape mean = rest.MeanOf(flown);
      passage.shift[plane][k] = mean.deflection;
      passage.turn_1_m[plane][k] = mean.slope_1_m;
      for (int mode = 0; mode < modes_; ++mode) {
        // By the orthogonality of the lighter stack's modes, also against its motions as a rigid body.
        const ModeAt its(*to.modes, plane, mode, propellant_kg);
        passage.onto[plane][static_cast<std::size_t>(mode)][k] =
            rest.Product(its, flown) / rest.Product(its, its);
      }
    }
  return passage;
}

}  // namespace dispersa
