#include "services/coordinator/health.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <iterator>
#include <system_error>

namespace dispersa {
namespace {

// A launch stores a text and a state, each first beside its place.
constexpr std::uint64_t kLeastBytes = 1 << 20, kLeastFiles = 16;
// A database and its copy, a report, a control law's process.
constexpr std::ptrdiff_t kLeastDescriptors = 16;

}  // namespace

void Health::Beat(Clock::time_point now) {
  const Lock lock(mutex_);
  beat_ = now;
}

void Health::SetPause(const std::string& reason) {
  const Lock lock(mutex_);
  pause_ = reason;
}

std::string WhyDiskIsFull(const std::filesystem::path& folder) {
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0) return "";
  if (disk.f_bavail * disk.f_frsize < kLeastBytes)
    return fmt::format("{}: no space left on the disk: less than 1 MB is free", folder.string());
  // Some file systems count no files.
  if (disk.f_files > 0 && disk.f_favail < kLeastFiles)
    return fmt::format("{}: no space left on the disk: {} more files can be made", folder.string(),
                       disk.f_favail);
  return "";
}

std::string WhyDescriptorsAreShort() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur == RLIM_INFINITY) return "";
  std::error_code error;
  const std::filesystem::directory_iterator open("/proc/self/fd", error);
  const auto left =
      error ? 0 : static_cast<std::ptrdiff_t>(limit.rlim_cur) - std::distance(begin(open), end(open));
  if (error.value() != EMFILE && (error || left >= kLeastDescriptors)) return "";
  return fmt::format("too many files are open: {} of {} are left (`ulimit -n`, LimitNOFILE of a unit)",
                     std::max<std::ptrdiff_t>(left, 0), limit.rlim_cur);
}

std::string Health::WhyDead(Clock::time_point now) const {
  const Lock lock(mutex_);
  if (beat_ == Clock::time_point() || now - beat_ <= kNoBeat) return "";
  return fmt::format("it has not heard itself for {} s",
                     std::chrono::duration_cast<std::chrono::seconds>(now - beat_).count());
}

std::string Health::WhyNotReady(Clock::time_point now) const {
  if (std::string dead = WhyDead(now); !dead.empty()) return dead;
  const Lock lock(mutex_);
  if (!pause_.empty()) return pause_;
  return beat_ == Clock::time_point() ? "it starts and has not heard itself yet" : "";
}

}  // namespace dispersa
