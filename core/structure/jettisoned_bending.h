// Bending of a stack that jettisons bodies: its modes change as each of them leaves.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>

#include "core/structure/bending_modes.h"
#include "core/structure/bending_table.h"

namespace dispersa {

/// What the modes of a stack become when it lets go of bodies. What stays keeps the place and the speed of
/// each of its masses: as a motion of the lighter stack's mean axes, and as motions of its modes.
struct ModalPassage {
  /// By plane and old mode, for a unit of it: how far what stays moves (m/m) and turns (1/m), in the mean.
  std::array<std::array<double, kModes>, kPlanes> shift{}, turn_1_m{};
  /// By plane, new mode and old mode: the new one's coordinate for a unit of the old one.
  std::array<std::array<std::array<double, kModes>, kModes>, kPlanes> onto{};
};

/// The tables of one stack, by what has left. A body carries mass and no stiffness, as a grain does, so the
/// sections stay. Each table is made when a flight first needs it: eight bodies can leave in 256 ways, of
/// which flights know one or two. Any thread may ask.
class JettisonedBending {
 public:
  /// `whole` and `table`: with all bodies. The vehicle has a beam without a table of modes. `near`: of the
  /// same vehicle with other masses, or null (BuildStackModes).
  JettisonedBending(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const StackModes> whole,
                    std::shared_ptr<const BendingTable> table, std::shared_ptr<const LoadTable> loads,
                    std::shared_ptr<const JettisonedBending> near = nullptr);

  /// Without the bodies of `gone` (BuildBeamMasses); it lives as long as this object.
  const BendingTable& Without(unsigned gone) const;

  /// From `before` to `after`, both as `gone`, with so much propellant left.
  ModalPassage Passage(unsigned before, unsigned after, double propellant_kg) const;

 private:
  struct Lighter {
    std::shared_ptr<const StackModes> modes;
    std::shared_ptr<const BendingTable> table;
  };
  const Lighter& Of(unsigned gone) const;

  std::shared_ptr<const Vehicle> vehicle_;
  int stage_;
  std::shared_ptr<const LoadTable> loads_;
  std::shared_ptr<const JettisonedBending> near_;
  int modes_;
  unsigned carried_ = 0;  ///< by this stack
  mutable std::mutex mutex_;
  mutable std::map<unsigned, std::unique_ptr<const Lighter>> made_;
};

}  // namespace dispersa
