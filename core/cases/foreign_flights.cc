#include "core/cases/foreign_flights.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/cases/result_bytes.h"
#include "core/flight/engine_version.h"
#include "core/flight/lane_engine.h"

namespace dispersa {
namespace {

// For a process that the system cannot give now.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kBetweenTries(500);

}  // namespace

// How a process ended that did not fly all its cases, and the case that it flew then.
struct ForeignFlights::BrokenOff {
  std::string how;
  std::uint64_t case_index;
};

struct ForeignFlights::Pool {
  explicit Pool(const std::string& canonical_yaml) : text(canonical_yaml) {}

  /// The one of a campaign: the last one again, if it is of this.
  static std::shared_ptr<Pool> Of(const std::string& canonical_yaml) {
    static std::mutex last_mutex;
    static std::shared_ptr<Pool> last;
    const std::lock_guard lock(last_mutex);
    if (last == nullptr || last->text != canonical_yaml) last = std::make_shared<Pool>(canonical_yaml);
    return last;
  }

  std::unique_ptr<ForeignProcess> Take() {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        std::unique_ptr<ForeignProcess> process = std::move(idle.back());
        idle.pop_back();
        return process;
      }
    }
    auto process = std::make_unique<ForeignProcess>();
    Packer order;
    order.Text(EngineVersion());
    order.Text(text);
    process->Ask(kCampaignOrder + order.Take(), [](const std::string&) {});
    return process;
  }
  void GiveBack(std::unique_ptr<ForeignProcess> process) {
    const std::lock_guard lock(mutex);
    if (process->is_usable()) idle.push_back(std::move(process));
  }

  const std::string text;
  std::mutex mutex;
  std::vector<std::unique_ptr<ForeignProcess>> idle;
};

ForeignFlights::ForeignFlights(const std::string& canonical_yaml, const FlightsHere& here)
    : pool_(Pool::Of(canonical_yaml)), here_(here) {}

void ForeignFlights::Fly(const std::string& order, const std::function<void(FlownOnce flown)>& hear,
                         const StopCheck& should_stop) const {
  std::unique_ptr<ForeignProcess> process = pool_->Take();
  try {
    process->Ask(
        kFlightOrder + order, [&](const std::string& message) { hear(TakeAnswer(here_, message)); },
        should_stop);
  } catch (...) {
    pool_->GiveBack(std::move(process));
    throw;
  }
  pool_->GiveBack(std::move(process));
}

// Takes those from `cases` that are flown.
std::optional<ForeignFlights::BrokenOff> ForeignFlights::FlyTogether(std::vector<std::uint64_t>& cases,
                                                                     CaseQueue& queue) const {
  const std::vector<std::uint64_t> wanted = cases;
  for (int tries = 1;; ++tries) {
    try {
      Fly(OrderCases(cases), [&](FlownOnce flown) {
        if (std::erase(cases, flown.result.case_index) == 0) throw Garbled();
        queue.Done(std::move(flown.result));
      });
      return std::nullopt;
    } catch (const ContainedEnd& end) {
      return BrokenOff{end.what(), end.at().case_index};
    } catch (const PluginError& error) {
      return BrokenOff{error.what(), wanted.front()};
    } catch (const NoChild&) {
      if (tries == kTries) throw;
      std::this_thread::sleep_for(kBetweenTries);
    }
  }
}

void ForeignFlights::FlyCases(CaseQueue& queue) const {
  // Twice the lanes: most of the flights of a process find their lanes filled.
  const std::size_t most = 2 * static_cast<std::size_t>(ChosenEngine().lanes);
  for (;;) {
    std::vector<std::uint64_t> cases;
    while (cases.size() < most) {
      const std::optional<std::uint64_t> next = queue.Next(cases.empty());
      if (!next) break;
      cases.push_back(*next);
    }
    if (cases.empty()) return;
    while (!cases.empty()) {
      const std::optional<BrokenOff> broken = FlyTogether(cases, queue);
      if (!broken || cases.empty()) break;
      // The case that it flew is flown alone, before the others go on together.
      const auto found = std::find(cases.begin(), cases.end(), broken->case_index);
      const std::uint64_t case_index = found == cases.end() ? cases.front() : *found;
      std::erase(cases, case_index);
      std::vector<std::uint64_t> alone = {case_index};
      if (const auto again = FlyTogether(alone, queue); again && !alone.empty())
        queue.Quarantined(case_index, "the control law " + again->how);
    }
  }
}

}  // namespace dispersa
