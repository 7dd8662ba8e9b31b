// Restarts the coordinator in the same process when its middleware does not recover.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace dispersa {

/// Decides when to restart. A pure state machine; times are seconds during which this program was awake.
class RestartRule {
 public:
  /// Restart after kNoReports_s without reports, if there is work and reports came before. Restart after
  /// kHang_s in which the thread makes no round.
  static constexpr double kNoReports_s = 10.0, kHang_s = 20.0;

  /// Takes the present observations. True: restart.
  bool Check(double now_s, bool receives, bool has_work, long rounds);

 private:
  bool has_received_ = false;
  double received_s_ = 0.0, round_s_ = 0.0;
  long rounds_ = -1;
};

/// Whether a watchdog started this program; asked once, before any thread starts.
bool IsStartedByItself();

/// A coordinator may be restarted at any moment: its state is on its disk, or its workers repeat it until it
/// is. A restart also ends locks and stale connections inside the middleware. The watchdog has a thread of
/// its own, because the message thread may hang.
class Watchdog {
 public:
  /// `arguments`: the command line of the restarted program.
  explicit Watchdog(std::vector<std::string> arguments);

  /// Call it in each round: whether reports arrive, and whether there is work, so that they should.
  void Note(bool receives, bool has_work) {
    receives_ = receives;
    has_work_ = has_work;
    ++rounds_;
  }

 private:
  void Watch(const std::stop_token& stop);

  std::vector<std::string> arguments_;
  std::atomic<bool> receives_ = false, has_work_ = false;
  std::atomic<long> rounds_ = 0;
  std::jthread thread_;
};

}  // namespace dispersa
