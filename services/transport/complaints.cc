#include "services/transport/complaints.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <map>

#include "services/log/log.h"
#include "services/program/mutex.h"
#include "services/transport/validity.h"

namespace dispersa {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPause(1);

struct Kind {
  Clock::time_point quiet_until;
  std::uint64_t unsaid = 0;
};

Mutex mutex;
std::map<std::string, Kind> kinds DISPERSA_GUARDED_BY(mutex);  // few: those that this program names
std::atomic<std::uint64_t> total = 0;

}  // namespace

void Complain(const std::string& kind, const std::string& sender, const std::string& what) {
  ++total;
  std::uint64_t unsaid = 0;
  {
    const Lock lock(mutex);
    Kind& known = kinds[kind];
    const auto now = Clock::now();
    if (now < known.quiet_until) {
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
