#include "services/transport/complaints.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>

#include "core/input/printable.h"
#include "services/log/log.h"
#include "services/program/mutex.h"

namespace dispersa {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPause(1);
constexpr std::size_t kMaxRemembered = 1000;

struct Kind {
  Clock::time_point quiet_until;
  std::uint64_t unsaid = 0;
};

Mutex mutex;
std::map<std::string, Kind> kinds DISPERSA_GUARDED_BY(mutex);  // few: those that this program names
RepeatedComplaints repeated DISPERSA_GUARDED_BY(mutex);
std::atomic<std::uint64_t> total = 0;

double Now_s() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

}  // namespace

bool RepeatedComplaints::IsDue(const std::string& complaint, double now_s) {
  if (said_.size() >= kMaxRemembered && !said_.contains(complaint)) said_.clear();
  const auto [found, is_new] = said_.try_emplace(complaint, Said{now_s, 1.0});
  Said& said = found->second;
  if (is_new) return true;
  if (now_s - said.at_s < said.pause_s) return false;
  const bool goes_on = now_s - said.at_s < 2.0 * said.pause_s + kLongest_s;
  said = {now_s, goes_on ? std::min(2.0 * said.pause_s, kLongest_s) : 1.0};
  return true;
}

void Complain(const std::string& kind, const std::string& sender, const std::string& what) {
  ++total;
  std::uint64_t unsaid = 0;
  {
    const Lock lock(mutex);
    Kind& known = kinds[kind];
    const auto now = Clock::now();
    if (now < known.quiet_until || !repeated.IsDue(kind + sender + what, Now_s())) {
      ++known.unsaid;
      return;
    }
    known.quiet_until = now + kPause;
    std::swap(unsaid, known.unsaid);
  }
  // Limited above, by kinds of its own.
  Log(LogLevel::kWarning, "",
      fmt::format("{} from {} is refused: {}{}", kind, Printable(sender), Printable(what),
                  unsaid == 0 ? "" : " (and " + std::to_string(unsaid) + " more before)"));
}

std::uint64_t Complaints() { return total; }

}  // namespace dispersa
