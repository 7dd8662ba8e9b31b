// A flown case as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>

#include "core/campaign/case_result.h"

namespace dispersa {

/// Inputs and metrics at some positions of their lists, by name: {"thrust_factor_stage1": 1.01, ...}. An
/// undefined value is null.
nlohmann::ordered_json InputsJson(const std::vector<std::size_t>& positions,
                                  const std::vector<double>& values);
/// All inputs of a result.
nlohmann::ordered_json InputsJson(const RowInputs& rows, const CaseResult& result);
nlohmann::ordered_json MetricsJson(const std::vector<double>& metrics, const MetricList& list,
                                   const std::vector<std::size_t>& positions);

/// A list of {"event": "lift_off", "time_s": 0, ...}.
nlohmann::ordered_json EventsJson(const std::vector<SeenEvent>& events);

/// "completed", or the outcome with time, stage and reason.
std::string OutcomeText(const CaseResult& result);

}  // namespace dispersa
