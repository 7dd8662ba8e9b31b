// Bending of a stack that jettisons bodies. Its modes change when a body leaves.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>

#include "core/structure/bending_modes.h"
#include "core/structure/bending_table.h"

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

/// The tables of one stack, by the set of bodies that have left. A body has mass and no stiffness, as a grain
/// has, so the sections stay. A table is made when a flight first needs it, because flights use one or two of
/// the 256 sets of eight bodies. Thread-safe.
class JettisonedBending {
 public:
  /// `whole` and `table`: with all bodies. The vehicle has a beam without a table of modes. `near`: that of
  /// the same vehicle with its nominal masses, or null (BuildStackModesNear).
  JettisonedBending(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const StackModes> whole,
                    std::shared_ptr<const BendingTable> table, std::shared_ptr<const LoadTable> loads,
                    std::shared_ptr<const JettisonedBending> near = nullptr);

  /// The table without the bodies of `gone` (BuildBeamMasses). It lives as long as this object.
  const BendingTable& Without(unsigned gone) const;

  /// The change from the set `before` to the set `after` of bodies that have left, at this propellant.
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
  unsigned carried_ = 0;  ///< bodies that this stack carries
  mutable std::mutex mutex_;
  mutable std::map<unsigned, std::unique_ptr<const Lighter>> made_;
};

}  // namespace dispersa
