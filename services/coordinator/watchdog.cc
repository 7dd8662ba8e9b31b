#include "services/coordinator/watchdog.h"
#include "services/log/log.h"
#include "services/program/exit_code.h"

#include <linux/close_range.h>
#include <pthread.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kPeriod(250);
constexpr char kByItself[] = "DISPERSA_STARTED_BY_ITSELF";

/// Returns only if it fails.
void StartAgain(std::vector<std::string>& arguments) {
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  // Sockets, whose ports the new program needs, and locks.
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  setenv(kByItself, "1", 1);
  execv("/proc/self/exe", words.data());
  LogError("the program cannot be started again: {}", std::strerror(errno));
}

}  // namespace

bool IsStartedByItself() {
  const bool is = std::getenv(kByItself) != nullptr;
  unsetenv(kByItself);
  return is;
}

bool RestartRule::Check(double now_s, bool receives, bool has_work, long beats) {
  if (beats != beats_) {
    beats_ = beats;
    beat_s_ = now_s;
  }
  has_received_ = has_received_ || receives;
  if (receives || !has_work) received_s_ = now_s;
  return now_s - beat_s_ > (beats_ == 0 ? kNoFirstBeat_s : kNoBeat_s) ||
         (has_received_ && now_s - received_s_ > kNoReports_s);
}

Watchdog::Watchdog(std::vector<std::string> arguments, std::shared_ptr<const Pulse> pulse, Health& health)
    : arguments_(std::move(arguments)),
      pulse_(std::move(pulse)),
      health_(health),
      thread_([this](const std::stop_token& stop) { Watch(stop); }) {}

// The time is what the thread has slept, not the clock's: a program that was stopped, or a machine that
// slept, has missed nothing.
void Watchdog::Watch(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), "watchdog");
  RestartRule rule;
  long heard = 0;
  for (double awake_s = 0.0; !stop.stop_requested();
       awake_s += std::chrono::duration<double>(kPeriod).count()) {
    std::this_thread::sleep_for(kPeriod);
    const long beats = pulse_->beats();
    if (beats != heard) health_.Beat();
    heard = beats;
    if (!rule.Check(awake_s, receives_, has_work_, beats)) continue;
    LogWarning("no messages arrive any more: the coordinator restarts");
    StartAgain(arguments_);
    // Whoever supervises this program starts it again.
    std::_Exit(kExitInternalError);
  }
}

}  // namespace dispersa
