#include "core/modes/beam_source.h"

#include <algorithm>
#include <utility>

#include "core/structure/free_body.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

// The shapes of a plane's modes at masses, by mode and mass: linear between two levels of the table, and held
// beyond.
std::vector<std::vector<StationShape>> ShapesAt(const StackModes& stack, std::size_t plane, int modes,
                                                const std::vector<MassPoint>& points, double propellant_kg) {
  const std::vector<BendingLevel>& levels = stack.levels[plane];
  std::size_t at = 0;
  while (at + 2 < levels.size() && propellant_kg < levels[at + 1].propellant_kg) ++at;
  const BendingLevel &low = levels[at], &high = levels[std::min(at + 1, levels.size() - 1)];
  double within = 0.0;
  if (&low != &high)
    within =
        std::clamp((low.propellant_kg - propellant_kg) / (low.propellant_kg - high.propellant_kg), 0.0, 1.0);
  std::vector<BeamPlace> places;
  for (const MassPoint& m : points) places.push_back(PlaceAt(stack, kBeamPlanes[plane], m.fixed_at_m));
  std::vector<std::vector<StationShape>> shapes(static_cast<std::size_t>(modes));
  for (std::size_t mode = 0; mode < shapes.size(); ++mode)
    for (const BeamPlace& place : places) {
      const StationShape a = place.Of(low.modes[mode]), b = place.Of(high.modes[mode]);
      shapes[mode].push_back({a.deflection + within * (b.deflection - a.deflection),
                              a.slope_1_m + within * (b.slope_1_m - a.slope_1_m)});
    }
  return shapes;
}

auto ByNumber(const std::vector<StationShape>& shapes) {
  return [&shapes](const MassPoint&, std::size_t i) { return shapes[i]; };
}

}  // namespace

BeamSource::BeamSource(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const StackModes> whole,
                       std::shared_ptr<const LoadTable> loads, int modes,
                       std::shared_ptr<const BeamSource> near)
    : vehicle_(std::move(vehicle)),
      stage_(whole->stage),
      loads_(std::move(loads)),
      near_(std::move(near)),
      modes_(modes),
      carried_(CarriedBy(*vehicle_, stage_)) {
  const BeamTable* const near_table = near_ ? near_->Lighter(0u).table.get() : nullptr;
  auto table =
      std::make_shared<const BeamTable>(BuildBeamTable(*vehicle_, *whole, *loads_, modes_, near_table));
  made_[0] = std::make_unique<const Stack>(Stack{std::move(whole), std::move(table)});
}

std::shared_ptr<const BeamSource> BeamSource::Below(double highest_rad_s,
                                                    std::shared_ptr<const Vehicle> vehicle, int stage,
                                                    std::shared_ptr<const LoadTable> loads) {
  auto whole = std::make_shared<const StackModes>(BuildStackModes(*vehicle, stage));
  int modes = ModesBelow(*vehicle, *whole, highest_rad_s);
  // Without a mass no frequency is lower: what flies with none of the bodies flies with any.
  if (const unsigned carried = CarriedBy(*vehicle, stage))
    modes = std::min(modes, ModesBelow(*vehicle, BuildStackModes(*vehicle, stage, carried), highest_rad_s));
  return std::make_shared<const BeamSource>(std::move(vehicle), std::move(whole), std::move(loads), modes);
}

std::shared_ptr<const ModeSource> BeamSource::Of(std::shared_ptr<const Vehicle> vehicle,
                                                 std::shared_ptr<const LoadTable> loads) const {
  const StackModes& nominal = *Lighter(0u).modes;
  // A table of modes is of the nominal masses, and is scaled to others as it stands.
  const bool is_solved = nominal.basis != nullptr;
  if (is_solved && modes_ == 0) return shared_from_this();
  auto whole = std::make_shared<const StackModes>(is_solved ? BuildStackModesNear(*vehicle, nominal, modes_)
                                                            : BuildStackModes(*vehicle, stage_));
  return std::make_shared<const BeamSource>(std::move(vehicle), std::move(whole), std::move(loads), modes_,
                                            is_solved ? shared_from_this() : nullptr);
}

const BeamSource::Stack& BeamSource::Lighter(unsigned gone) const {
  gone &= carried_;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<const Stack>& made = made_[gone];
  if (!made) {
    const Stack* const near = near_ ? &near_->Lighter(gone) : nullptr;
    auto modes =
        std::make_shared<const StackModes>(near ? BuildStackModesNear(*vehicle_, *near->modes, modes_)
                                                : BuildStackModes(*vehicle_, stage_, gone));
    auto table = std::make_shared<const BeamTable>(
        BuildBeamTable(*vehicle_, *modes, *loads_, modes_, near ? near->table.get() : nullptr));
    made = std::make_unique<const Stack>(Stack{std::move(modes), std::move(table)});
  }
  return *made;
}

ModalPassage BeamSource::Passage(unsigned before, unsigned after, double propellant_kg) const {
  const Stack &from = Lighter(before), &to = Lighter(after);
  const FreeBody rest(BuildBeamMasses(*vehicle_, stage_, propellant_kg, after & carried_),
                      from.modes->station_m[0]);
  ModalPassage passage;
  const bool is_same = from.modes->axisymmetric && to.modes->axisymmetric;
  for (std::size_t plane = 0; plane < kPlanes; ++plane) {
    if (plane > 0 && is_same) {
      passage.shift[plane] = passage.shift[0];
      passage.turn_1_m[plane] = passage.turn_1_m[0];
      passage.onto[plane] = passage.onto[0];
      continue;
    }
    const auto flown = ShapesAt(*from.modes, plane, modes_, rest.points, propellant_kg);
    const auto lighter = ShapesAt(*to.modes, plane, modes_, rest.points, propellant_kg);
    for (std::size_t old = 0; old < flown.size(); ++old) {
      const StationShape mean = rest.MeanOf(ByNumber(flown[old]));
      passage.shift[plane][old] = mean.deflection;
      passage.turn_1_m[plane][old] = mean.slope_1_m;
    }
    for (std::size_t mode = 0; mode < lighter.size(); ++mode) {
      // By the orthogonality of the lighter stack's modes, also against its motions as a rigid body.
      const auto its = ByNumber(lighter[mode]);
      const double mass_kg = rest.Product(its, its);
      for (std::size_t old = 0; old < flown.size(); ++old)
        passage.onto[plane][mode][old] = rest.Product(its, ByNumber(flown[old])) / mass_kg;
    }
  }
  return passage;
}

}  // namespace dispersa
