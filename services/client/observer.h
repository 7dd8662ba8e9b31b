// Who watches a long call, and may stop it.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Thrown by a call whose observer wanted it to stop.
struct Interrupted {};

/// Called by any of the threads that fly, one at a time but for Stop.
class Observer {
 public:
  virtual ~Observer() = default;
  /// How far a phase ("table3", "time histories") is. Cheap calls, many a second: showing each is up to the
  /// observer.
  virtual void Show(const std::string& phase, std::uint64_t done, std::uint64_t total,
                    const std::string& note = "") = 0;
  /// The phase has ended: what is said now is not about it.
  virtual void EndPhase() {}
  /// Asked many times a second.
  virtual bool Stop() = 0;
};

}  // namespace dispersa
