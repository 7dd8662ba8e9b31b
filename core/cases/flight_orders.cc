#include "core/cases/flight_orders.h"

#include <utility>

#include "core/cases/result_bytes.h"
#include "core/flight/flight_model.h"
#include "core/flight/lane_engine.h"
#include "core/input/printable.h"

namespace dispersa {
namespace {

constexpr char kFlight = 'f', kCases = 'c', kSideBySide = 's';

std::string AnswerOf(const CaseResult& result, const std::vector<double>& history) {
  Packer out;
  Pack(result, out);
  out.Numbers(history);
  return out.Take();
}

// Cases that are known, results that are said.
class ListedCases : public CaseQueue {
 public:
  ListedCases(std::vector<std::uint64_t> cases, const Say& say) : cases_(std::move(cases)), say_(say) {}

  std::optional<std::uint64_t> Next(bool) override {
    if (next_ == cases_.size()) return std::nullopt;
    return cases_[next_++];
  }
  void Done(CaseResult result) override { say_(AnswerOf(result, {})); }
  void Quarantined(std::uint64_t, const std::string&) override {}

 private:
  std::vector<std::uint64_t> cases_;
  const Say& say_;
  std::size_t next_ = 0;
};

void FlySideBySide(const FlightsHere& flights, const std::vector<std::optional<std::uint64_t>>& cases,
                   const Say& say) {
  std::vector<History> histories(cases.size());
  std::vector<FlightOrder> orders(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    histories[i].step_s = flights.model().definition().autopilot.tick_s;
    if (cases[i]) orders[i].inputs = flights.Draw(*cases[i]);
    orders[i].options.case_index = cases[i].value_or(0);
    orders[i].options.history = &histories[i];
  }
  std::vector<FlightResult> results = FlyAll(flights.model(), orders);
  for (std::size_t i = 0; i < cases.size(); ++i)
    say(AnswerOf(ResultOf(flights.rows(), cases[i].value_or(0), orders[i].inputs, std::move(results[i])),
                 histories[i].values));
}

}  // namespace

std::string OrderFlight(const FlightInputs& inputs, std::uint64_t case_index,
                        std::optional<double> history_step_s, Scheme scheme) {
  Packer out;
  out.Value(kFlight);
  out.Value(inputs);
  out.Value(case_index);
  out.Value(history_step_s.has_value());
  out.Value(history_step_s.value_or(0.0));
  out.Value(scheme);
  return out.Take();
}

std::string OrderCases(const std::vector<std::uint64_t>& cases) {
  Packer out;
  out.Value(kCases);
  out.Value(cases.size());
  for (const std::uint64_t each : cases) out.Value(each);
  return out.Take();
}

std::string OrderSideBySide(const std::vector<std::optional<std::uint64_t>>& cases) {
  Packer out;
  out.Value(kSideBySide);
  out.Value(cases.size());
  for (const auto& each : cases) {
    out.Value(each.has_value());
    out.Value(each.value_or(0));
  }
  return out.Take();
}

void CarryOut(const FlightsHere& flights, const std::string& order, const Say& say) {
  Unpacker in(order);
  const char kind = in.Value<char>();
  if (kind == kFlight) {
    const auto inputs = in.Value<FlightInputs>();
    const auto case_index = in.Value<std::uint64_t>();
    const bool wants_history = in.Value<bool>();
    History history;
    history.step_s = in.Value<double>();
    const auto scheme = in.Value<Scheme>();
    const CaseResult result = flights.Fly(inputs, case_index, wants_history ? &history : nullptr, scheme);
    say(AnswerOf(result, history.values));
    return;
  }
  const auto count = in.Value<std::size_t>();
  if (kind == kCases) {
    std::vector<std::uint64_t> cases;
    while (cases.size() < count) cases.push_back(in.Value<std::uint64_t>());
    ListedCases listed(std::move(cases), say);
    flights.FlyCases(listed);
    return;
  }
  std::vector<std::optional<std::uint64_t>> cases;
  while (cases.size() < count) {
    const bool is_case = in.Value<bool>();
    const auto index = in.Value<std::uint64_t>();
    cases.push_back(is_case ? std::optional(index) : std::nullopt);
  }
  FlySideBySide(flights, cases, say);
}

FlownOnce TakeAnswer(const FlightsHere& flights, const std::string& message) {
  Unpacker in(message);
  FlownOnce flown;
  flown.result = UnpackResult(in);
  flown.history = in.Numbers();
  if (!in.is_whole() || !flights.IsResult(flown.result) ||
      flown.history.size() % HistoryColumns().size() != 0)
    throw Garbled();
  flown.result.reason = Printable(flown.result.reason, 1000);
  return flown;
}

}  // namespace dispersa
