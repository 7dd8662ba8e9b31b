#include "services/client/flight_json.h"

#include <fmt/format.h>

#include <numeric>

#include "core/flight/flight_inputs.h"
#include "core/results/json_number.h"

namespace dispersa {

nlohmann::ordered_json InputsJson(const std::vector<std::size_t>& positions,
                                  const std::vector<double>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < positions.size(); ++i)
    json[InputColumns()[positions[i]].name] = Number(values[i]);
  return json;
}

nlohmann::ordered_json InputsJson(const RowInputs& rows, const CaseResult& result) {
  const std::vector<double> all = rows.AllOf(result.inputs);
  std::vector<std::size_t> positions(all.size());
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  return InputsJson(positions, all);
}

nlohmann::ordered_json MetricsJson(const std::vector<double>& metrics, const MetricList& list,
                                   const std::vector<std::size_t>& positions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const std::size_t i : positions) json[list.NameAt(i)] = Number(metrics[i]);
  return json;
}

nlohmann::ordered_json EventsJson(const std::vector<SeenEvent>& events) {
  return ListOf(events, [](const SeenEvent& event) {
    nlohmann::ordered_json json = {{"event", event.name}};
    for (std::size_t i = 0; i < kEventValueNames.size(); ++i)
      json[kEventValueNames[i]] = Number(event.*SeenEvent::kValues[i]);
    return json;
  });
}

std::string OutcomeText(const CaseResult& result) {
  if (result.outcome == Outcome::kCompleted) return OutcomeName(result.outcome);
  return fmt::format("{} at {:.2f} s in stage {}: {}", OutcomeName(result.outcome), result.end_time_s,
                     result.end_stage, result.reason);
}

}  // namespace dispersa
