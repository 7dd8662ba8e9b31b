#include "core/cases/campaign_flights.h"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "core/cases/foreign_flights.h"
#include "core/control/law_here.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_model.h"
#include "core/flight/lane_engine.h"

namespace dispersa {

CampaignFlights::CampaignFlights(const Campaign& campaign) : here_(campaign) {
  const auto& plugin = campaign.autopilot.plugin;
  if (plugin && FunctionsHere(*plugin) == nullptr)
    foreign_ = std::make_unique<ForeignFlights>(campaign.canonical_yaml, here_);
}

CampaignFlights::~CampaignFlights() = default;

CaseResult CampaignFlights::FlyCase(std::uint64_t case_index, History* history) const {
  return Fly(Draw(case_index), case_index, history);
}

CaseResult CampaignFlights::FlyNominal(History* history) const { return Fly(FlightInputs{}, 0, history); }

CaseResult CampaignFlights::Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                                Scheme scheme) const {
  if (foreign_ == nullptr) return here_.Fly(inputs, case_index, history, scheme);
  const auto step_s = history != nullptr ? std::optional(history->step_s) : std::nullopt;
  std::vector<FlownOnce> flown = FlyOrdered(OrderFlight(inputs, case_index, step_s, scheme));
  if (flown.size() != 1) throw ContainedEnd("returned no valid result", PluginMark{});
  if (history != nullptr) history->values = std::move(flown[0].history);
  return std::move(flown[0].result);
}

std::vector<FlownOnce> CampaignFlights::FlyOrdered(const std::string& order,
                                                   const StopCheck& should_stop) const {
  std::vector<FlownOnce> all;
  if (foreign_ != nullptr) {
    foreign_->Fly(
        order, [&](FlownOnce flown) { all.push_back(std::move(flown)); }, should_stop);
  } else {
    CarryOut(here_, order, [&](const std::string& message) { all.push_back(TakeAnswer(here_, message)); });
  }
  return all;
}

namespace {

// A list of cases that threads share.
struct SharedOrders {
  const CampaignFlights& flights;
  const std::vector<CaseOrder>& orders;
  const CaseObserver& done;
  std::mutex mutex = {};
  std::size_t next = 0;
  std::exception_ptr problem = {};

  std::optional<std::size_t> Next() {
    const std::lock_guard lock(mutex);
    if (next == orders.size() || problem) return std::nullopt;
    return next++;
  }
  void Done(std::size_t order, CaseResult result, const History& history) {
    const std::lock_guard lock(mutex);
    if (problem) return;
    try {
      done(order, std::move(result), history);
    } catch (...) {
      problem = std::current_exception();
    }
  }
};

// The orders that one thread flies.
class FlyingOrders : public FlightQueue {
 public:
  explicit FlyingOrders(SharedOrders& shared) : shared_(shared) {}

  FlightRecord* Next(bool) override {
    const std::optional<std::size_t> order = shared_.Next();
    if (!order) return nullptr;
    const CaseOrder& wanted = shared_.orders[*order];
    auto flight = std::make_unique<InFlight>();
    flight->order = *order;
    FlightOrder to_fly{shared_.flights.Draw(wanted.case_index), {}};
    to_fly.options.case_index = wanted.case_index;
    if (wanted.history_step_s > 0.0) {
      if (!rooms_.empty()) {
        flight->history.values = std::move(rooms_.back());
        rooms_.pop_back();
      }
      flight->history.step_s = wanted.history_step_s;
      to_fly.options.history = &flight->history;
    }
    flight->record = std::make_unique<FlightRecord>(shared_.flights.model(), to_fly);
    FlightRecord* const record = flight->record.get();
    flying_[record] = std::move(flight);
    return record;
  }
  void Done(FlightRecord* record) override {
    auto ended = flying_.extract(record);
    CaseResult result =
        ResultOf(shared_.flights.rows(), record->options.case_index, record->inputs, record->Result());
    shared_.Done(ended.mapped()->order, std::move(result), ended.mapped()->history);
    if (record->options.history != nullptr) rooms_.push_back(std::move(ended.mapped()->history.values));
  }

 private:
  struct InFlight {
    std::size_t order = 0;
    History history;
    std::unique_ptr<FlightRecord> record;
  };
  SharedOrders& shared_;
  std::map<FlightRecord*, std::unique_ptr<InFlight>> flying_;
  /// Memory of histories that have been observed. Growing it anew for each flight costs more than filling it.
  std::vector<std::vector<double>> rooms_;
};

// The same where every flight has a process of its own.
void FlyOneByOne(SharedOrders& shared) {
  while (const std::optional<std::size_t> order = shared.Next()) {
    const CaseOrder& wanted = shared.orders[*order];
    History history;
    history.step_s = wanted.history_step_s;
    try {
      CaseResult result =
          shared.flights.FlyCase(wanted.case_index, wanted.history_step_s > 0.0 ? &history : nullptr);
      shared.Done(*order, std::move(result), history);
    } catch (...) {
      const std::lock_guard lock(shared.mutex);
      if (!shared.problem) shared.problem = std::current_exception();
    }
  }
}

}  // namespace

void CampaignFlights::FlyCases(CaseQueue& queue) const {
  if (foreign_ != nullptr) return foreign_->FlyCases(queue);
  here_.FlyCases(queue);
}

void CampaignFlights::FlyCases(const std::vector<CaseOrder>& orders, int threads,
                               const CaseObserver& done) const {
  SharedOrders shared{*this, orders, done};
  const auto fly = [&] {
    if (foreign_ != nullptr) return FlyOneByOne(shared);
    FlyingOrders flying(shared);
    ChosenEngine().fly(model(), flying);
  };
  {
    std::vector<std::jthread> others;  // joined at the end of this block
    const auto useful = (orders.size() + static_cast<std::size_t>(ChosenEngine().lanes) - 1) /
                        static_cast<std::size_t>(ChosenEngine().lanes);
    for (std::size_t i = 1; i < std::min(useful, static_cast<std::size_t>(std::max(1, threads))); ++i)
      others.emplace_back(fly);
    fly();
  }
  if (shared.problem) std::rethrow_exception(shared.problem);
}

std::optional<CaseResult> NominalOf(const Campaign& campaign, const std::string& engine) {
  if (campaign.autopilot.plugin || engine != EngineVersion()) return std::nullopt;
  return CampaignFlights(campaign).FlyNominal();
}

}  // namespace dispersa
