#include "core/campaign/case_result.h"

#include <utility>

#include "core/flight/flight_model.h"

namespace dispersa {

std::vector<std::size_t> MeasuredMetrics(const Campaign& campaign) {
  return MetricsUnder(campaign.vehicle.stages.size(), campaign.autopilot.pitch.law);
}

std::string WhyNotMeasured(const Campaign& campaign, const std::string& metric) {
  const std::size_t column = MetricColumn(metric);
  if (column >= MetricCount(campaign.vehicle.stages.size())) return "is of a stage that the vehicle has not";
  const ControlLaw law = campaign.autopilot.pitch.law;
  if (HasMetric(Metrics()[column], law)) return "";
  return "is of flights whose law of pitch is " + LawsWith(Metrics()[column]) + "; here it is " +
         InfoOf(law).name;
}

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
