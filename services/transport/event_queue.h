// Hands events from the middleware's threads to the one thread that acts on them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace dispersa {

template <typename Event>
class EventQueue {
 public:
  /// What comes when so many wait already is dropped: senders repeat what matters.
  static constexpr std::size_t kMaxWaiting = 20000;

  /// False: dropped.
  bool Push(Event event) {
    {
      const std::lock_guard lock(mutex_);
      if (events_.size() >= kMaxWaiting) return false;
      events_.push_back(std::move(event));
    }
    changed_.notify_one();
    return true;
  }

  /// All events so far, in order; waits for the first one, at most `timeout`.
  std::vector<Event> Wait(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return !events_.empty(); });
    return std::exchange(events_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Event> events_;
};

}  // namespace dispersa
