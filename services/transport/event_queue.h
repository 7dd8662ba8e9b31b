// Hands events from the middleware's threads to the one thread that acts on them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <utility>
#include <vector>

#include "services/program/mutex.h"

namespace dispersa {

template <typename Event>
class EventQueue {
 public:
  /// With this number of waiting events, further ones are dropped. Senders repeat important messages.
  static constexpr std::size_t kMaxWaiting = 20000;

  /// False: dropped.
  bool Push(Event event) {
    {
      const Lock lock(mutex_);
      if (events_.size() >= kMaxWaiting) return false;
      events_.push_back(std::move(event));
    }
    changed_.notify_one();
    return true;
  }

  /// All events so far, in order. Waits at most `timeout` for the first one.
  std::vector<Event> Wait(std::chrono::milliseconds timeout) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    Lock lock(mutex_);
    while (events_.empty() && lock.WaitUntil(changed_, deadline)) {
    }
    return std::exchange(events_, {});
  }

 private:
  Mutex mutex_;
  std::condition_variable changed_;
  std::vector<Event> events_ DISPERSA_GUARDED_BY(mutex_);
};

}  // namespace dispersa
