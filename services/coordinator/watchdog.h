// Starts this program again, in the same process, when its middleware does not come back from what froze it.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace dispersa {

/// When to start again. A pure state machine; times in seconds that this program was awake.
class RestartRule {
 public:
  /// Having heard somebody before, a coordinator with work that receives nobody for so long is deaf; a thread
  /// that makes no round for so long hangs.
  static constexpr double kNoReports_s = 10.0, kHang_s = 20.0;

  /// What is seen now. True: start again.
  bool Check(double now_s, bool receives, bool has_work, long rounds);

 private:
  bool has_received_ = false;
  double received_s_ = 0.0, round_s_ = 0.0;
  long rounds_ = -1;
};

/// Whatever a coordinator knows is on its disk, or repeated by its workers until it is, so it may be started
/// again at any moment; what the middleware knows of others dies with it, and what it has locked itself up in
/// too. Runs a thread of its own, since the one that talks may be what hangs.
class Watchdog {
 public:
  /// `arguments`: of the program that takes this one's place.
  explicit Watchdog(std::vector<std::string> arguments);

  /// Of each round: whether somebody is heard, and whether anybody needs to be.
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
