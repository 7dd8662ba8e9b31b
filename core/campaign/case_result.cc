#include "core/campaign/case_result.h"

#include <utility>

#include "core/flight/flight_model.h"

namespace dispersa {

CaseResult ResultOf(const FlightModel& model, std::uint64_t case_index, const FlightInputs& inputs,
                    FlightResult flight) {
  CaseResult result;
  result.case_index = case_index;
  result.outcome = flight.outcome;
  result.end_time_s = flight.end_time_s;
  result.end_stage = flight.end_stage;
  result.reason = std::move(flight.reason);
  result.inputs = InputValues(inputs, model.definition().vehicle.stages.size());
  result.metrics = std::move(flight.metrics);
  result.digest = flight.digest;
  return result;
}

}  // namespace dispersa
