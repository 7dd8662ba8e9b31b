// Receives the progress of a long call, and can stop it.
#pragma once

#include <cstdint>
#include <string>

#include "core/containment/interrupted.h"

namespace dispersa {

/// Any flying thread may call it. Calls never overlap, except those of ShouldStop.
class Observer {
 public:
  virtual ~Observer() = default;
  /// The progress of a phase ("table3", "time histories"). Called many times a second. The observer decides
  /// how many calls it shows.
  virtual void Show(const std::string& phase, std::uint64_t done, std::uint64_t total,
                    const std::string& note = "") = 0;
  /// The phase has ended: later messages are not about it.
  virtual void EndPhase() {}
  /// Asked many times a second. True: the call throws Interrupted.
  virtual bool ShouldStop() = 0;
};

}  // namespace dispersa
