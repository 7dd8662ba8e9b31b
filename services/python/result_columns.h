// Results by column, as Python has them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/outcome.h"
#include "services/python/arrays.h"

namespace dispersa {

/// Names of the metrics at these positions.
inline std::vector<std::string> NamesOf(const MetricList& list, const std::vector<std::size_t>& metrics) {
  std::vector<std::string> names;
  for (const std::size_t i : metrics) names.push_back(list.NameAt(i));
  return names;
}

/// Names of the inputs at these positions.
inline std::vector<std::string> NamesOfInputs(const std::vector<std::size_t>& positions) {
  std::vector<std::string> names;
  for (const std::size_t i : positions) names.push_back(InputColumns()[i].name);
  return names;
}

/// Gather without the interpreter's lock; take with it.
class ResultColumns {
 public:
  /// `inputs`: positions in InputColumns() of those that each result has. `metrics`: positions in the list of
  /// those that are kept.
  ResultColumns(std::vector<std::size_t> inputs, MetricList list, std::vector<std::size_t> metrics)
      : list_(std::move(list)), input_columns_(std::move(inputs)), metric_columns_(std::move(metrics)) {}

  /// A result with as many inputs and metrics.
  void Add(const CaseResult& result) {
    index_.push_back(result.case_index);
    outcome_.push_back(OutcomeName(result.outcome));
    end_time_s_.push_back(result.end_time_s);
    end_stage_.push_back(result.end_stage);
    reason_.push_back(result.reason);
    inputs_.insert(inputs_.end(), result.inputs.begin(), result.inputs.end());
    for (const std::size_t i : metric_columns_) metrics_.push_back(result.metrics[i]);
    digest_.push_back(result.digest.Hex());
  }
  /// The columns of cases.csv, `input_names` and `metric_names`. Inputs and metrics have the shape (results,
  /// names).
  pybind11::dict Take() {
    const auto rows = static_cast<pybind11::ssize_t>(index_.size());
    pybind11::dict columns;
    columns["case_index"] = ArrayOf(std::move(index_));
    columns["outcome"] = outcome_;
    columns["end_time_s"] = ArrayOf(std::move(end_time_s_));
    columns["end_stage"] = ArrayOf(std::move(end_stage_));
    columns["reason"] = reason_;
    columns["inputs"] =
        ArrayOf(std::move(inputs_), {rows, static_cast<pybind11::ssize_t>(input_columns_.size())});
    columns["input_names"] = NamesOfInputs(input_columns_);
    columns["metrics"] =
        ArrayOf(std::move(metrics_), {rows, static_cast<pybind11::ssize_t>(metric_columns_.size())});
    columns["metric_names"] = NamesOf(list_, metric_columns_);
    columns["digest"] = digest_;
    return columns;
  }

 private:
  MetricList list_;
  std::vector<std::size_t> input_columns_;
  std::vector<std::size_t> metric_columns_;
  std::vector<std::uint64_t> index_;
  std::vector<std::string> outcome_, reason_, digest_;
  std::vector<double> end_time_s_, inputs_, metrics_;
  std::vector<std::int32_t> end_stage_;
};

}  // namespace dispersa
