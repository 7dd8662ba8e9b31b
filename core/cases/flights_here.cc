#include "core/cases/flights_here.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/campaign/flight_definition.h"
#include "core/control/law_here.h"
#include "core/flight/flight.h"
#include "core/flight/lane_engine.h"
#include "core/input/input_error.h"
#include "core/math/assertion.h"

namespace dispersa {
namespace {

// A campaign flown with a control law in Python can be read anywhere, but flown only by a process with the
// law.
const Campaign& WithItsLaw(const Campaign& campaign) {
  const auto& plugin = campaign.autopilot.plugin;
  if (plugin && IsAbsent(*plugin)) {
    throw InputError(
        "flown with a Python law, '" + plugin->name + "', which is not here: its cases cannot be flown again",
        "in Python, with that law as law=...");
  }
  return campaign;
}

// The cases of a queue as flights of the engine.
class FlyingCases : public FlightQueue {
 public:
  FlyingCases(const FlightsHere& flights, CaseQueue& cases) : flights_(flights), cases_(cases) {}

  FlightRecord* Next(bool idle) override {
    const std::optional<std::uint64_t> case_index = cases_.Next(idle);
    if (!case_index) return nullptr;
    FlightOrder order{flights_.Draw(*case_index), {}};
    order.options.case_index = *case_index;
    auto record = std::make_unique<FlightRecord>(flights_.model(), order);
    FlightRecord* const flying = record.get();
    flying_[flying] = std::move(record);
    return flying;
  }
  void Done(FlightRecord* record) override {
    const auto ended = flying_.extract(record);
    DISPERSA_ASSERT(!ended.empty(), record->options.case_index);
    CaseResult result =
        ResultOf(flights_.rows(), record->options.case_index, record->inputs, record->Result());
    DISPERSA_ASSERT(flights_.IsResult(result), result.case_index, result.end_stage, result.metrics.size());
    cases_.Done(std::move(result));
  }

 private:
  const FlightsHere& flights_;
  CaseQueue& cases_;
  std::map<FlightRecord*, std::unique_ptr<FlightRecord>> flying_;
};

}  // namespace

FlightsHere::FlightsHere(const Campaign& campaign)
    : design_(WithItsLaw(campaign)),
      rows_(campaign),
      model_(std::make_unique<FlightModel>(DefinitionOf(campaign))),
      metrics_(MetricsOf(campaign).size()) {}

FlightsHere::~FlightsHere() = default;

CaseResult FlightsHere::Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                            Scheme scheme) const {
  FlightOptions options;
  options.scheme = scheme;
  options.case_index = case_index;
  options.history = history;
  return ResultOf(rows_, case_index, model_->AsApplied(inputs), dispersa::Fly(*model_, inputs, options));
}

void FlightsHere::FlyCases(CaseQueue& queue) const {
  FlyingCases flying(*this, queue);
  ChosenEngine().fly(*model_, flying);
}

bool FlightsHere::IsResult(const CaseResult& result) const {
  const int outcome = static_cast<int>(result.outcome);
  const auto& stages = model_->definition().vehicle.stages;
  return outcome >= 0 && outcome < kOutcomeCount && result.end_stage >= 0 &&
         result.end_stage <= static_cast<int>(stages.size()) && result.metrics.size() == metrics_ &&
         result.inputs.size() == rows_.positions().size() &&
         std::all_of(result.events.begin(), result.events.end(),
                     [](const SeenEvent& event) { return IsEventName(event.name); });
}

}  // namespace dispersa
