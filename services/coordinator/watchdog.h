// Restarts the coordinator in the same process when its middleware does not recover.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "services/coordinator/health.h"
#include "services/transport/pulse.h"

namespace dispersa {

/// Decides when to restart. A pure state machine; times are seconds during which this program was awake.
class RestartRule {
 public:
  /// Restart after kNoReports_s without reports, if there is work and reports came before. Restart after
  /// kNoBeat_s without a beat of the pulse (pulse.h), or kNoFirstBeat_s without the first one: the machine
  /// may be busy with hundreds of handshakes.
  static constexpr double kNoReports_s = 10.0, kNoBeat_s = 20.0, kNoFirstBeat_s = 60.0;

  /// Takes the present observations. True: restart.
  bool Check(double now_s, bool receives, bool has_work, long beats);

 private:
  bool has_received_ = false;
  double received_s_ = 0.0, beat_s_ = 0.0;
  long beats_ = 0;
};

/// Whether a watchdog started this program; asked once, before any thread starts.
bool IsStartedByItself();

/// A coordinator may be restarted at any moment: its state is on its disk, or its workers repeat it until it
/// is. A restart also ends locks and stale connections inside the middleware. The watchdog has a thread of
/// its own, because the message thread may hang, and asks nothing of the middleware.
class Watchdog {
 public:
  /// `arguments`: the command line of the restarted program. `health` learns of the beats.
  Watchdog(std::vector<std::string> arguments, std::shared_ptr<const Pulse> pulse, Health& health);

  /// Call it in each round: whether reports arrive, and whether there is work, so that they should.
  void Note(bool receives, bool has_work) {
    receives_ = receives;
    has_work_ = has_work;
  }

 private:
  void Watch(const std::stop_token& stop);

  std::vector<std::string> arguments_;
  std::shared_ptr<const Pulse> pulse_;
  Health& health_;
  std::atomic<bool> receives_ = false, has_work_ = false;
  std::jthread thread_;
};

}  // namespace dispersa
