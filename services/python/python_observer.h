// Lets Python watch a long call: a function of the caller gets the progress, and Ctrl-C stops the call.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "services/client/observer.h"

namespace dispersa {

/// Make and destroy it with the interpreter's lock; use it without.
class PythonObserver : public Observer {
 public:
  /// `progress(phase, done, total, note)`, or None.
  explicit PythonObserver(pybind11::object progress) : progress_(std::move(progress)) {}

  void Show(const std::string& phase, std::uint64_t done, std::uint64_t total,
            const std::string& note = "") override {
    if (progress_.is_none() || stopped_) return;
    const auto now = std::chrono::steady_clock::now();
    if (phase == phase_ && done < total && now - shown_ < kShowPeriod) return;
    phase_ = phase;
    shown_ = now;
    const pybind11::gil_scoped_acquire lock;
    try {
      progress_(phase, done, total, note);
    } catch (const pybind11::error_already_set&) {
      StopWith(std::current_exception());
    }
  }
  bool ShouldStop() override {
    // Python handles signals in its main thread only. In another thread the call is harmless.
    if (stopped_ || std::this_thread::get_id() != caller_) return stopped_;
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_ < kAskPeriod) return false;
    asked_ = now;
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) StopWith(std::make_exception_ptr(pybind11::error_already_set()));
    return stopped_;
  }

  /// Ends the watched work, which then raises `problem`. Needs the interpreter's lock.
  void StopWith(std::exception_ptr problem) {
    if (!problem_) problem_ = std::move(problem);
    stopped_ = true;
  }

  /// Calls `function` without the interpreter's lock. Raises what the caller's function or a signal raised.
  template <typename Function>
  auto Watch(const Function& function) {
    try {
      const pybind11::gil_scoped_release free;
      return function();
    } catch (const Interrupted&) {
      if (problem_) std::rethrow_exception(problem_);
      throw;
    }
  }

 private:
  static constexpr std::chrono::milliseconds kShowPeriod{100};
  static constexpr std::chrono::milliseconds kAskPeriod{50};

  pybind11::object progress_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<bool> stopped_ = false;
  std::exception_ptr problem_;
  std::string phase_;
  std::chrono::steady_clock::time_point shown_, asked_;
};

}  // namespace dispersa
