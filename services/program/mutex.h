// Locks of which a compiler proves that they are held: clang's -Wthread-safety, as
// tests/distributed/locks_test.py runs it. To other compilers these are std::mutex and std::unique_lock.
#pragma once

#include <condition_variable>
#include <mutex>

#if defined(__clang__)
#define DISPERSA_PROVED(what) __attribute__((what))
#else
#define DISPERSA_PROVED(what)
#endif
/// For a member: only a holder of this Mutex may read or write it.
#define DISPERSA_GUARDED_BY(mutex) DISPERSA_PROVED(guarded_by(mutex))

namespace dispersa {

class DISPERSA_PROVED(capability("mutex")) Mutex {
 private:
  friend class Lock;
  std::mutex mutex_;
};

/// Holds a mutex as long as it lives.
class DISPERSA_PROVED(scoped_lockable) Lock {
 public:
  explicit Lock(Mutex& mutex) DISPERSA_PROVED(acquire_capability(mutex)) : lock_(mutex.mutex_) {}
  ~Lock() DISPERSA_PROVED(release_capability()) {}  // a default one could not say what it releases
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  /// May return without a notification, as a condition variable may. It then holds the mutex again.
  void Wait(std::condition_variable& changed) { changed.wait(lock_); }
  /// False: the time has come.
  template <typename Time>
  bool WaitUntil(std::condition_variable& changed, const Time& time) {
    return changed.wait_until(lock_, time) == std::cv_status::no_timeout;
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace dispersa
