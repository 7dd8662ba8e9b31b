// The result of a flown case: the same bits wherever, whenever and however often it is flown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/row_inputs.h"
#include "core/flight/digest.h"
#include "core/flight/flight.h"
#include "core/flight/metric_list.h"
#include "core/flight/metrics.h"

namespace dispersa {

struct CaseResult {
  std::uint64_t case_index = 0;
  Outcome outcome = Outcome::kNumericalFailure;
  double end_time_s = 0.0;     ///< since lift-off
  int end_stage = 0;           ///< 1-based stage burning, or last burnt, at the end
  std::string reason;          ///< one sentence (empty when completed)
  std::vector<double> inputs;  ///< those of the campaign's rows (RowInputs), as applied
  Digest inputs_digest;        ///< InputsDigest() of all inputs, as applied
  /// In the order of MetricsOf the campaign. NaN: undefined, or not measured under its law.
  std::vector<double> metrics;
  Digest digest;
  std::vector<SeenEvent> events;  ///< in the order of their times
};

/// The metrics of the campaign's vehicle, then its own.
MetricList MetricsOf(const Campaign& campaign);
/// Positions in MetricsOf of those that the campaign's flights have: under its law, to its end and target, of
/// stages that it controls or not.
std::vector<std::size_t> MeasuredMetrics(const Campaign& campaign);
/// Of those that any flight under its law may have: what programs of others make results of.
std::vector<std::size_t> ResultMetrics(const Campaign& campaign);
/// Why the campaign's flights lack a metric: "is of flights whose law of pitch is ..."; empty if they have
/// it.
std::string WhyNotMeasured(const Campaign& campaign, const std::string& metric);

/// "The nominal flight itself is lost: lost_control at 9.37 s in stage 1 (reason)."; empty if it was
/// completed. It comes before anything else that is said of a campaign.
std::string NominalLoss(const CaseResult& nominal);

/// The result of a flight of these inputs, as a case's result.
CaseResult ResultOf(const RowInputs& rows, std::uint64_t case_index, const FlightInputs& inputs,
                    FlightResult flight);
/// Gives a result what its flight applied: a value for each input of the vehicle.
void SetInputs(const RowInputs& rows, const std::vector<double>& all, CaseResult& result);
/// Whether a result has these inputs, to the last bit, and its flight applied these constants.
bool HasInputs(const RowInputs& rows, const std::vector<double>& all, const CaseResult& result);

}  // namespace dispersa
