// Made-up results of two campaigns for a comparison.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/comparison.h"
#include "core/results/case_columns.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::comparison_sample {

/// One input (all the others unread) and one metric a case; every flight is completed.
inline CaseColumns Columns(const std::vector<std::uint64_t>& index, const std::vector<double>& input,
                           const std::vector<double>& metric, const char* name = "pitch_error_rms_deg") {
  CaseColumns cases;
  cases.index = index;
  cases.outcome.assign(index.size(), Outcome::kCompleted);
  cases.inputs.resize(InputCount(kUsualStages));
  cases.inputs[0] = input;
  cases.metrics.assign(MetricCount(kUsualStages),
                       CaseColumn(std::vector<double>(index.size(), report_test::kNaN)));
  cases.metrics[MetricColumn(name)] = metric;
  return cases;
}

/// `requirements` are those of A.
inline Comparison CompareColumns(const CaseColumns& a, const CaseColumns& b,
                                 const std::vector<Requirement>& requirements = {},
                                 const std::vector<std::string>& metrics = {}) {
  Campaign of_a = report_test::MakeCampaign(a.rows());
  const Campaign of_b = report_test::MakeCampaign(b.rows());
  of_a.requirements = requirements;
  return Compare({"A", "engine", of_a, a}, {"B", "engine", of_b, b}, metrics, {});
}

}  // namespace dispersa::comparison_sample
