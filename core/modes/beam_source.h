// The bending modes of a stack's beam, as a source of modes in flight. They change when a body leaves.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "core/modes/beam_table.h"
#include "core/modes/mode_source.h"
#include "core/structure/bending_modes.h"

namespace dispersa {

/// The tables of one stack, by the set of bodies that have left. A body has mass and no stiffness, as a grain
/// has, so the sections stay. A table is made when a flight first needs it, because flights use one or two of
/// the 256 sets of eight bodies.
class BeamSource : public ModeSource, public std::enable_shared_from_this<BeamSource> {
 public:
  /// The first `modes` of `whole`, the stack with all bodies. The vehicle has a beam. One with a table of
  /// modes jettisons nothing. `near`: that of the same vehicle with its nominal masses, or null
  /// (BuildStackModesNear).
  BeamSource(std::shared_ptr<const Vehicle> vehicle, std::shared_ptr<const StackModes> whole,
             std::shared_ptr<const LoadTable> loads, int modes,
             std::shared_ptr<const BeamSource> near = nullptr);
  /// The modes of the stack of a stage that stay below `highest_rad_s` all the burn, whatever has left.
  static std::shared_ptr<const BeamSource> Below(double highest_rad_s, std::shared_ptr<const Vehicle> vehicle,
                                                 int stage, std::shared_ptr<const LoadTable> loads);

  std::shared_ptr<const ModeTable> Without(unsigned gone) const override { return Lighter(gone).table; }
  ModalPassage Passage(unsigned before, unsigned after, double propellant_kg) const override;
  std::shared_ptr<const ModeSource> Of(std::shared_ptr<const Vehicle> vehicle,
                                       std::shared_ptr<const LoadTable> loads) const override;

 private:
  struct Stack {
    std::shared_ptr<const StackModes> modes;
    std::shared_ptr<const BeamTable> table;
  };
  const Stack& Lighter(unsigned gone) const;

  std::shared_ptr<const Vehicle> vehicle_;
  int stage_;
  std::shared_ptr<const LoadTable> loads_;
  std::shared_ptr<const BeamSource> near_;
  int modes_;
  unsigned carried_ = 0;  ///< bodies that this stack carries
  mutable std::mutex mutex_;
  mutable std::map<unsigned, std::unique_ptr<const Stack>> made_;
};

}  // namespace dispersa
