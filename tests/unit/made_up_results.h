// Made-up results for the tests of results, analysis and pages: no flight is flown.
#pragma once

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/history.h"
#include "core/flight/metrics.h"
#include "core/results/result_error.h"
#include "tests/every_metric.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"
#include "tests/unit/distributions.h"

namespace dispersa::report_test {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline Campaign MakeCampaign(std::uint64_t cases) {
  Campaign campaign;
  campaign.name = "made_up";
  campaign.sampling = {SamplingMethod::kMonteCarlo, cases, 7};
  campaign.vehicle.name = "vehicle";
  campaign.reference.name = "reference";
  campaign.autopilot.name = "autopilot";
  MeasureEverything(campaign);
  campaign.dispersions = {made_up::Of("drag_coefficient", made_up::Normal(1.0, 0.1), "drag_factor")};
  campaign.canonical_yaml = "name: made_up\n";
  campaign.id = std::string(64, '1');
  campaign.flight_id = std::string(64, '2');
  return campaign;
}

/// With a limit that nothing reaches: its folder stores every metric.
inline Campaign MakeLimitedCampaign(std::uint64_t cases) {
  Campaign campaign = MakeCampaign(cases);
  campaign.vehicle.limits.axial_load_g = 1e9;
  return campaign;
}

/// The metrics of a case, and its end, differ from each other and between cases; the inputs of its row
/// between cases.
inline CaseResult MakeCase(std::uint64_t index, const RowInputs& rows = RowInputs(MakeCampaign(1))) {
  CaseResult result;
  result.case_index = index;
  result.outcome = Outcome::kCompleted;
  result.end_time_s = 569.25;
  result.end_stage = 4;
  const auto k = static_cast<double>(index);
  ApplyEverywhere(rows, 0.1 + k / 7.0, result);
  for (std::size_t i = 0; i < MetricCount(kUsualStages); ++i)
    result.metrics.push_back(1.0 + static_cast<double>(i) + k / 3.0);
  result.metrics[MetricColumn("step_limit_fraction")] = 0.5;  // nobody is to be warned
  result.digest = {index + 1, 0xabcdef};
  result.events = {{"lift_off", 0.0, 10.0 + k, 0.5, 0.25, 9000.0 - k},
                   {"stage_1_burnout", 60.0 + k / 3.0, 21500.0, 2000.0 + k / 7.0, 4000.0, 5000.0}};
  return result;
}

/// Of an action that throws such a ResultError.
inline auto Fails(ResultError::Kind kind, const std::string& text) {
  return Throws<ResultError>(
      AllOf(Property(&ResultError::kind, kind), Property(&ResultError::what, StrEq(text))));
}

inline constexpr char kPeak[] = "pitch_error_peak_deg";

inline Requirement PeakBelow(double limit, double probability, double consumer_risk) {
  return {kPeak, limit, {}, probability, consumer_risk};
}

}  // namespace dispersa::report_test
