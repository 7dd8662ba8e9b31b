#include "core/results/result_differences.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/flight/flight_inputs.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

bool SameStored(double first, double second) {
  if (!std::isfinite(first) || !std::isfinite(second)) return std::isfinite(first) == std::isfinite(second);
  return std::bit_cast<std::uint64_t>(first + 0.0) == std::bit_cast<std::uint64_t>(second + 0.0);
}

std::string Shown(double value) { return std::isfinite(value) ? ShortestText(value) : "undefined"; }

void CompareNumber(const std::string& name, double first, double second,
                   std::vector<ResultDifference>& differences) {
  if (!SameStored(first, second)) differences.push_back({name, Shown(first), Shown(second)});
}

void CompareText(const std::string& name, const std::string& first, const std::string& second,
                 std::vector<ResultDifference>& differences) {
  if (first != second) differences.push_back({name, first, second});
}

}  // namespace

std::vector<ResultDifference> Differences(const CaseResult& first, const CaseResult& second,
                                          const RowInputs& inputs, const MetricList& metrics) {
  std::vector<ResultDifference> differences;
  CompareText("outcome", OutcomeName(first.outcome), OutcomeName(second.outcome), differences);
  CompareText("reason", first.reason, second.reason, differences);
  CompareNumber("end_time_s", first.end_time_s, second.end_time_s, differences);
  CompareNumber("end_stage", first.end_stage, second.end_stage, differences);
  for (std::size_t i = 0; i < first.inputs.size(); ++i) {
    CompareNumber("input_" + InputColumns()[inputs.positions()[i]].name, first.inputs[i], second.inputs[i],
                  differences);
  }
  CompareText("inputs_digest", first.inputs_digest.Hex(), second.inputs_digest.Hex(), differences);
  for (std::size_t i = 0; i < first.metrics.size(); ++i) {
    CompareNumber("metric_" + metrics.NameAt(i), first.metrics[i], second.metrics[i], differences);
  }
  CompareText("digest", first.digest.Hex(), second.digest.Hex(), differences);
  return differences;
}

}  // namespace dispersa
