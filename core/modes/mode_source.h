// A source of modes of a stack in flight.
#pragma once

#include <array>
#include <memory>

#include "core/modes/mode_table.h"

namespace dispersa {

/// The change of a stack's modal coordinates when bodies leave. The remaining masses keep their positions and
/// velocities. These become a motion of the lighter stack's mean axes and motions of its modes.
struct ModalPassage {
  /// By plane and old mode: mean displacement (m/m) and rotation (1/m) of the remaining stack for a unit of
  /// the mode.
  std::array<std::array<double, kModes>, kPlanes> shift{}, turn_1_m{};
  /// By plane, new mode and old mode: coordinate of the new mode for a unit of the old one.
  std::array<std::array<std::array<double, kModes>, kModes>, kPlanes> onto{};
};

/// What has modes of its own: the beam of a stack. A source says how its modes are seen and driven, by rows
/// of a table. So flights need to know nothing of where a mode comes from. Its modes are the same in number
/// over the stack's flight. Thread-safe.
class ModeSource {
 public:
  virtual ~ModeSource() = default;

  /// The table without the bodies of `gone` (LauncherPhase::jettisoned).
  virtual std::shared_ptr<const ModeTable> Without(unsigned gone) const = 0;
  /// The change from the set `before` to the set `after` of bodies that have left, at this propellant.
  virtual ModalPassage Passage(unsigned before, unsigned after, double propellant_kg) const = 0;
  /// The same modes of a vehicle with other masses than this nominal one.
  virtual std::shared_ptr<const ModeSource> Of(std::shared_ptr<const Vehicle> vehicle,
                                               std::shared_ptr<const LoadTable> loads) const = 0;
};

}  // namespace dispersa
