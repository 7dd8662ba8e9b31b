#include "services/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "services/cli/terminal.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kBarPeriod(100);
constexpr std::chrono::seconds kLinePeriod(5);
constexpr std::size_t kBarWidth = 30;
constexpr std::size_t kUsualProgressWidth = 80;

}  // namespace

std::string ProgressBar(std::uint64_t done, std::uint64_t total) {
  // More may be done than there is: the total of a campaign that stops when decided changes.
  const double fraction =
      static_cast<double>(std::min(done, total)) / static_cast<double>(std::max<std::uint64_t>(total, 1));
  const auto filled = static_cast<std::size_t>(fraction * kBarWidth);
  return std::string(filled, '#') + std::string(kBarWidth - filled, '.');
}

std::string DurationText(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  return fmt::format("{}s", whole);
}

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\n", stderr);
}

void Progress::Show(std::uint64_t done, std::uint64_t total, const std::string& note) {
  if (quiet_ || total == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (!begun_) {
    begun_ = true;
    first_done_ = done;
    start_ = shown_ = now;
    if (!terminal_) return;
  } else if (now - shown_ < (terminal_ ? std::chrono::milliseconds(kBarPeriod) : kLinePeriod) &&
             done < total) {
    return;
  }
  shown_ = now;
  const double fraction = static_cast<double>(done) / static_cast<double>(total);
  std::string line = fmt::format("{}/{} ({:.0f} %)", done, total, 100.0 * fraction);
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  if (done > first_done_ && elapsed_s > 0.0) {
    const double rate = static_cast<double>(done - first_done_) / elapsed_s;
    line += fmt::format(", {:.3g}/s", rate);
    line += done < total ? fmt::format(", {} left", DurationText(static_cast<double>(total - done) / rate))
                         : fmt::format(", {}", DurationText(elapsed_s));
  }
  if (!note.empty()) line += ", " + note;
  if (terminal_) {
    const std::string bar = ProgressBar(done, total);
    // A line that wraps cannot be drawn over: "\r" returns to the start of its last row only. The last column
    // stays free, because some terminals wrap as soon as it is filled.
    const std::size_t columns = TerminalWidth(STDERR_FILENO, kUsualProgressWidth);
    Tell("\r\x1b[K{}", FitColumns(fmt::format("{} [{}] {}", what_, bar, line), columns - 1));
    drawn_ = true;
  } else {
    Tell("{}: {}\n", what_, line);
  }
  std::fflush(stderr);
}

}  // namespace dispersa
