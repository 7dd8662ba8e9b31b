// Time of a flight on one core, and its shares. Compare figures of one run with each other, not with another
// machine's.
#include <benchmark/benchmark.h>

#include <string>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/flight_queue.h"
#include "core/flight/lane_engine.h"

namespace dispersa {
namespace {

const Campaign& Table3() {
  static const Campaign campaign = LoadCampaign(std::string(DISPERSA_CAMPAIGNS) + "/table3.yaml");
  return campaign;
}

// A whole dispersed flight. Items are flights: items_per_second is flights per second and core.
void Flight(benchmark::State& state) {
  const CampaignFlights flights(Table3());
  std::uint64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(flights.FlyCase(index++));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Flight)->Unit(benchmark::kMillisecond)->MinTime(3.0);

// The cases of a campaign, taken in turn.
class Cases : public FlightQueue {
 public:
  Cases(const CampaignFlights& flights, std::uint64_t count) : flights_(flights), left_(count) {}

  FlightRecord* Next(bool) override {
    if (left_ == 0) return nullptr;
    FlightOrder order{flights_.Draw(--left_), {}};
    order.options.case_index = left_;
    return new FlightRecord(flights_.model(), order);
  }
  void Done(FlightRecord* record) override {
    benchmark::DoNotOptimize(record->Result());
    delete record;
  }

 private:
  const CampaignFlights& flights_;
  std::uint64_t left_;
};

// The same side by side, in every engine that this processor can run: instruction set / lanes. Items are
// flights.
void SideBySide(benchmark::State& state, const LaneEngine& engine) {
  const CampaignFlights flights(Table3());
  constexpr std::uint64_t kCases = 32;
  for (auto _ : state) {
    Cases cases(flights, kCases);
    engine.fly(flights.model(), cases);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCases));
}
const bool kRegistered = [] {
  for (const LaneEngine& engine : UsableEngines()) {
    benchmark::RegisterBenchmark(
        ("Flights/" + std::string(engine.isa) + "/" + std::to_string(engine.lanes)).c_str(), SideBySide,
        engine)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

// Time of a campaign before its first flight: tables, schedules, design.
void Preparation(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(CampaignFlights(Table3()).Draw(0));
}
BENCHMARK(Preparation)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dispersa
