// Whether a coordinator lives and takes campaigns, as probes are told (monitor_port.h).
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "services/program/mutex.h"

namespace dispersa {

/// Written by the coordinator's loop and its watchdog, read by the port's thread. Texts are empty if all is
/// well, else the reason in words.
class Health {
 public:
  using Clock = std::chrono::steady_clock;
  /// The watchdog restarts the coordinator after 20 s (RestartRule).
  static constexpr std::chrono::seconds kNoBeat{10};

  /// The coordinator has heard itself (pulse.h).
  void Beat(Clock::time_point now = Clock::now());
  /// Why it takes no campaigns now; empty: it does.
  void SetPause(const std::string& reason);

  /// A coordinator that starts lives: its first beat is not due yet.
  std::string WhyDead(Clock::time_point now = Clock::now()) const;
  std::string WhyNotReady(Clock::time_point now = Clock::now()) const;

 private:
  mutable Mutex mutex_;
  Clock::time_point beat_ DISPERSA_GUARDED_BY(mutex_){};  ///< the epoch: none yet
  std::string pause_ DISPERSA_GUARDED_BY(mutex_) = "it starts and reads its campaigns";
};

/// Why a launch cannot be stored below this folder. Empty: it can, or the system does not say.
std::string WhyDiskIsFull(const std::filesystem::path& folder);
/// Why a campaign cannot be opened: this process has few descriptors left. Empty: it can.
std::string WhyDescriptorsAreShort();

}  // namespace dispersa
