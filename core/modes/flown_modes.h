// All modes of a stack in flight, from its sources.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/modes/mode_source.h"

namespace dispersa {

/// One table of all modes: those of the first source, then those of the next. Modes of two sources do not act
/// on each other but through the body. Levels of propellant are those of any source. Residual flexibilities
/// add. Precondition: as many modes as a flight has room for (kModes).
ModeTable SideBySide(const std::vector<std::shared_ptr<const ModeTable>>& tables);

/// Thread-safe.
class FlownModes {
 public:
  explicit FlownModes(std::vector<std::shared_ptr<const ModeSource>> sources);

  /// The table without the bodies of `gone`. Made when a flight first needs it, because flights use one or
  /// two of the 256 sets of eight bodies.
  std::shared_ptr<const ModeTable> Without(unsigned gone) const;
  ModalPassage Passage(unsigned before, unsigned after, double propellant_kg) const;
  std::shared_ptr<const FlownModes> Of(const std::shared_ptr<const Vehicle>& vehicle,
                                       const std::shared_ptr<const LoadTable>& loads) const;

 private:
  std::vector<std::shared_ptr<const ModeSource>> sources_;
  mutable std::mutex mutex_;
  mutable std::map<unsigned, std::shared_ptr<const ModeTable>> made_;
};

/// The modes of the stack of a stage that is no restart, from all sources that its vehicle has: those below
/// `highest_rad_s` all the burn. Null: it is rigid.
std::shared_ptr<const FlownModes> FlownModesBelow(double highest_rad_s,
                                                  const std::shared_ptr<const Vehicle>& vehicle, int stage,
                                                  const std::shared_ptr<const LoadTable>& loads);

}  // namespace dispersa
