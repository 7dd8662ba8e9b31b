#include "core/cases/contained_flights.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/cases/result_bytes.h"
#include "core/containment/contained.h"
#include "core/flight/lane_engine.h"

namespace dispersa {
namespace {

// For a child that the system cannot give now.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kBetweenTries(500);

// The queue of a child: cases that are known, results that are said.
class ListedCases : public CaseQueue {
 public:
  ListedCases(std::vector<std::uint64_t> cases, const Say& say) : cases_(std::move(cases)), say_(say) {}

  std::optional<std::uint64_t> Next(bool) override {
    if (next_ == cases_.size()) return std::nullopt;
    return cases_[next_++];
  }
  void Done(CaseResult result) override {
    Packer out;
    Pack(result, out);
    say_(out.Take());
  }
  void Quarantined(std::uint64_t, const std::string&) override {}

 private:
  std::vector<std::uint64_t> cases_;
  const Say& say_;
  std::size_t next_ = 0;
};

// How a child ended that did not fly all its cases, and the case that it flew then.
struct BrokenOff {
  std::string how;
  std::uint64_t case_index;
};

// Flies `cases` in one child and takes those that it flew from them.
std::optional<BrokenOff> FlyInChild(const FlightsHere& flights, std::vector<std::uint64_t>& cases,
                                    CaseQueue& queue) {
  const std::vector<std::uint64_t> wanted = cases;
  for (int tries = 1;; ++tries) {
    try {
      RunContained(
          [&](const Say& say) {
            ListedCases listed(wanted, say);
            flights.FlyCases(listed);
          },
          [&](const std::string& message) {
            Unpacker in(message);
            CaseResult result = UnpackResult(in);
            if (!in.is_whole() || std::erase(cases, result.case_index) == 0) throw Garbled();
            queue.Done(std::move(result));
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

}  // namespace

CaseResult FlyContained(const FlightsHere& flights, const FlightInputs& inputs, std::uint64_t case_index,
                        History* history, Scheme scheme) {
  std::optional<CaseResult> result;
  RunContained(
      [&](const Say& say) {
        History flown;
        if (history != nullptr) flown.step_s = history->step_s;
        Packer out;
        Pack(flights.Fly(inputs, case_index, history != nullptr ? &flown : nullptr, scheme), out);
        out.Numbers(flown.values);
        say(out.Take());
      },
      [&](const std::string& message) {
        Unpacker in(message);
        result = UnpackResult(in);
        std::vector<double> values = in.Numbers();
        if (!in.is_whole()) throw Garbled();
        if (history != nullptr) history->values = std::move(values);
      });
  if (!result) throw Garbled();
  return *std::move(result);
}

void FlyContained(const FlightsHere& flights, CaseQueue& queue) {
  // Twice the lanes: most of the flights of a child find their lanes filled.
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
      const std::optional<BrokenOff> broken = FlyInChild(flights, cases, queue);
      if (!broken || cases.empty()) break;
      // The case that it flew is flown alone, before the others go on together.
      const auto found = std::find(cases.begin(), cases.end(), broken->case_index);
      const std::uint64_t case_index = found == cases.end() ? cases.front() : *found;
      std::erase(cases, case_index);
      std::vector<std::uint64_t> alone = {case_index};
      if (const auto again = FlyInChild(flights, alone, queue); again && !alone.empty())
        queue.Quarantined(case_index, "the control law " + again->how);
    }
  }
}

}  // namespace dispersa
