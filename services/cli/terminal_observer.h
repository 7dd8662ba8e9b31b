// A long command as a terminal shows it: a bar for each phase, and Ctrl-C to stop.
#pragma once

#include <optional>
#include <string>

#include "services/cli/progress.h"
#include "services/client/observer.h"
#include "services/program/stop_signal.h"

namespace dispersa {

class TerminalObserver : public Observer {
 public:
  explicit TerminalObserver(bool quiet) : quiet_(quiet) {}

  void Show(const std::string& phase, std::uint64_t done, std::uint64_t total,
            const std::string& note = "") override {
    if (!progress_ || phase != phase_) {
      progress_.reset();
      progress_.emplace(phase, quiet_);
      phase_ = phase;
    }
    progress_->Show(done, total, note);
  }
  void EndPhase() override { progress_.reset(); }
  /// Never true in a command that does not catch the stop signals: such a command ends by the signal.
  bool ShouldStop() override { return StopRequested(); }

 private:
  bool quiet_;
  std::string phase_;
  std::optional<Progress> progress_;
};

}  // namespace dispersa
