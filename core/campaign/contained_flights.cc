#include "core/campaign/contained_flights.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/campaign/contained.h"
#include "core/input/input_error.h"
#include "core/control/law_here.h"
#include "core/flight/flight_model.h"
#include "core/flight/history.h"
#include "core/flight/lane_engine.h"

namespace dispersa {
namespace {

// A child's words are bytes of the same program: values as they are, lists and texts behind their lengths.
class Packer {
 public:
  template <typename T>
  void Value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void Text(const std::string& text) {
    Value(text.size());
    bytes_ += text;
  }
  void Numbers(const std::vector<double>& numbers) {
    Value(numbers.size());
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// What a plug-in may have spoilt is read with care: beyond the end there are zeros.
class Unpacker {
 public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}

  template <typename T>
  T Value() {
    T value{};
    std::memcpy(&value, Part(sizeof value), sizeof value);
    return value;
  }
  std::string Text() {
    const auto size = Value<std::size_t>();
    return {Part(size), is_whole_ ? size : 0};
  }
  std::vector<double> Numbers() {
    const auto count = Value<std::size_t>();
    const char* const part = Part(count > bytes_.size() ? bytes_.size() + 1 : count * sizeof(double));
    if (!is_whole_) return {};
    std::vector<double> numbers(count);
    std::memcpy(numbers.data(), part, count * sizeof(double));
    return numbers;
  }
  bool is_whole() const { return is_whole_ && at_ == bytes_.size(); }

 private:
  const char* Part(std::size_t size) {
    static constexpr char kNothing[256] = {};
    if (!is_whole_ || size > bytes_.size() - at_) {
      is_whole_ = false;
      return kNothing;
    }
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
  bool is_whole_ = true;
};

void Pack(const CaseResult& result, Packer& out) {
  out.Value(result.case_index);
  out.Value(result.outcome);
  out.Value(result.end_time_s);
  out.Value(result.end_stage);
  out.Text(result.reason);
  out.Numbers(result.inputs);
  out.Numbers(result.metrics);
  out.Value(result.digest);
}

CaseResult UnpackResult(Unpacker& in) {
  CaseResult result;
  result.case_index = in.Value<std::uint64_t>();
  result.outcome = in.Value<Outcome>();
  result.end_time_s = in.Value<double>();
  result.end_stage = in.Value<int>();
  result.reason = in.Text();
  result.inputs = in.Numbers();
  result.metrics = in.Numbers();
  result.digest = in.Value<Digest>();
  return result;
}

// For a child that the system cannot give now.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kBetweenTries(500);

ContainedEnd Garbled() { return {"answered with what is no result", PluginMark{}}; }

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
  void GivenUp(std::uint64_t, const std::string&) override {}

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
std::optional<BrokenOff> FlyInChild(const CampaignFlights& flights, std::vector<std::uint64_t>& cases,
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

CaseResult FlyContained(const CampaignFlights& flights, const FlightInputs& inputs, std::uint64_t case_index,
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

void FlyContained(const CampaignFlights& flights, CaseQueue& queue) {
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
        queue.GivenUp(case_index, "the control law " + again->how);
    }
  }
}

namespace {

// A flight of the check: what it returned, and its history.
struct Flown {
  CaseResult result;
  std::vector<double> history;
};

FlightOrder OrderOf(const CampaignFlights& flights, std::optional<std::uint64_t> case_index,
                    History& history) {
  history.step_s = flights.model().definition().autopilot.tick_s;
  FlightOrder order;
  if (case_index) order.inputs = flights.Draw(*case_index);
  order.options.case_index = case_index.value_or(0);
  order.options.history = &history;
  return order;
}

// A law of this process is flown in it.
void RunWatched(const CampaignFlights& flights, const std::function<void(const Say& say)>& work,
                const Say& hear, const Unwanted& unwanted) {
  if (FunctionsHere(flights.model().autopilot().plugin->config()) != nullptr)
    work(hear);
  else
    RunContained(work, hear, unwanted);
}

// None is the nominal flight.
std::vector<Flown> FlySideBySide(const CampaignFlights& flights,
                                 const std::vector<std::optional<std::uint64_t>>& cases,
                                 const Unwanted& unwanted) {
  std::vector<Flown> all;
  RunWatched(
      flights,
      [&](const Say& say) {
        std::vector<History> histories(cases.size());
        std::vector<FlightOrder> orders;
        for (std::size_t i = 0; i < cases.size(); ++i)
          orders.push_back(OrderOf(flights, cases[i], histories[i]));
        std::vector<FlightResult> results = FlyAll(flights.model(), orders);
        for (std::size_t i = 0; i < cases.size(); ++i) {
          Packer out;
          Pack(ResultOf(flights.model(), cases[i].value_or(0), orders[i].inputs, std::move(results[i])), out);
          out.Numbers(histories[i].values);
          say(out.Take());
        }
      },
      [&](const std::string& message) {
        Unpacker in(message);
        CaseResult result = UnpackResult(in);
        all.push_back({std::move(result), in.Numbers()});
        if (!in.is_whole()) throw Garbled();
      },
      unwanted);
  return all;
}

std::string Difference(const std::vector<double>& first, const std::vector<double>& second) {
  const std::vector<std::string>& columns = HistoryColumns();
  const std::size_t size = std::min(first.size(), second.size());
  for (std::size_t i = 0; i < size; ++i) {
    if (std::memcmp(&first[i], &second[i], sizeof(double)) == 0) continue;
    char text[160];
    std::snprintf(text, sizeof text, "at %.3f s %s is %.17g once and %.17g again",
                  first[i - i % columns.size()], columns[i % columns.size()].c_str(), first[i], second[i]);
    return text;
  }
  return first.size() == second.size() ? "" : "one of the flights ends earlier";
}

// Of flights that ended well before.
std::vector<Flown> FlyAgain(const CampaignFlights& flights,
                            const std::vector<std::optional<std::uint64_t>>& cases,
                            const Unwanted& unwanted) {
  try {
    return FlySideBySide(flights, cases, unwanted);
  } catch (const ContainedEnd& end) {
    throw PluginError("is not deterministic: the same flight ended well once, and again it " +
                      std::string(end.what()));
  }
}

// Each once alone and once beside the others. Returns the cases' results.
std::vector<CaseResult> CompareFlights(const CampaignFlights& flights, std::uint64_t cases,
                                       const Unwanted& unwanted) {
  std::vector<std::optional<std::uint64_t>> checked = {std::nullopt};
  std::vector<Flown> alone, together;
  try {
    alone = FlySideBySide(flights, checked, unwanted);
  } catch (const ContainedEnd& end) {
    throw PluginError(std::string("cannot fly the nominal flight: it ") + end.what());
  }
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(cases, 2); ++i) checked.emplace_back(i);
  try {
    together = FlySideBySide(flights, checked, unwanted);
  } catch (const ContainedEnd&) {
    checked.resize(1);  // such a case is left to whoever flies the campaign
    together = FlyAgain(flights, checked, unwanted);
  }
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (i > 0) {
      std::vector<Flown> again = FlyAgain(flights, {checked[i]}, unwanted);
      std::move(again.begin(), again.end(), std::back_inserter(alone));
    }
    if (alone.size() != i + 1 || together.size() != checked.size())
      throw PluginError("answered with what is no result");
    const std::string difference = Difference(alone[i].history, together[i].history);
    if (difference.empty()) continue;
    throw PluginError(
        "is not deterministic: of " +
        (checked[i] ? "case " + std::to_string(*checked[i]) : std::string("the nominal flight")) +
        ", flown twice, " + difference);
  }
  std::vector<CaseResult> results;
  for (std::size_t i = 1; i < checked.size(); ++i) results.push_back(std::move(alone[i].result));
  return results;
}

}  // namespace

std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const Unwanted& unwanted) {
  const PluginLaw* const plugin = flights.model().autopilot().plugin.get();
  if (plugin == nullptr) return {};
  try {
    return CompareFlights(flights, cases, unwanted);
  } catch (const PluginError& error) {
    throw InputError("the control law " + plugin->config().name + " " + error.what());
  }
}

}  // namespace dispersa
