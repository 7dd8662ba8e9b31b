#include "core/campaign/case_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "core/flight/flight_inputs.h"
#include "core/flight/flight_model.h"
#include "core/input/read_value.h"

namespace dispersa {

namespace {

FlightKind KindOf(const Campaign& campaign) {
  FlightKind kind = dispersa::KindOf(campaign.vehicle, campaign.autopilot, campaign.course);
  const TrajectoryProblem& problem = campaign.reference.problem;
  kind.has_node = problem.target_node_rad.has_value();
  kind.has_argument_of_perigee = problem.target_argument_of_perigee_rad.has_value();
  kind.has_true_anomaly =
      problem.target_true_anomaly_rad || (kind.has_argument_of_perigee && !problem.is_entered_anywhere);
  return kind;
}

std::vector<std::size_t> MetricsOfKind(const Campaign& campaign, const FlightKind& kind) {
  const std::size_t stages = ColumnClass(campaign.vehicle);
  std::vector<std::size_t> positions = MetricsUnder(stages, kind);
  for (std::size_t i = 0; i < campaign.own_metrics.size(); ++i) positions.push_back(MetricCount(stages) + i);
  return positions;
}

}  // namespace

MetricList MetricsOf(const Campaign& campaign) {
  std::vector<std::string> own;
  for (const OwnMetric& metric : campaign.own_metrics) own.push_back(metric.name);
  return MetricList(ColumnClass(campaign.vehicle), std::move(own));
}

std::vector<std::size_t> MeasuredMetrics(const Campaign& campaign) {
  return MetricsOfKind(campaign, KindOf(campaign));
}

std::vector<std::size_t> ResultMetrics(const Campaign& campaign) {
  return MetricsOfKind(campaign, AnyUnder(campaign.autopilot.pitch.law));
}

std::string WhyNotMeasured(const Campaign& campaign, const std::string& metric) {
  const std::optional<std::size_t> position = MetricsOf(campaign).Find(metric);
  const auto known = std::find(MetricNames().begin(), MetricNames().end(), metric);
  if (!position && known != MetricNames().end()) return "is of a stage that the vehicle has not";
  if (!position) return "is not a metric" + DidYouMean(metric, NamesOf(MetricsOf(campaign)));
  if (known == MetricNames().end()) return "";
  const Metric& measured = Metrics()[*position];
  if (HasMetric(measured, KindOf(campaign))) return "";
  const ControlLaw law = campaign.autopilot.pitch.law;
  if (measured.of_law == nullptr || InfoOf(law).*measured.of_law)
    return "is of flights with " + NeedsOf(measured);
  return "is of flights whose law of pitch is " + LawsWith(Metrics()[*position]) + "; here it is " +
         InfoOf(law).name;
}

CaseResult ResultOf(const RowInputs& rows, std::uint64_t case_index, const FlightInputs& inputs,
                    FlightResult flight) {
  CaseResult result;
  result.case_index = case_index;
  result.outcome = flight.outcome;
  result.end_time_s = flight.end_time_s;
  result.end_stage = flight.end_stage;
  result.reason = std::move(flight.reason);
  SetInputs(rows, InputValues(inputs, rows.column_class()), result);
  result.metrics = std::move(flight.metrics);
  result.digest = flight.digest;
  result.events = std::move(flight.events);
  return result;
}

void SetInputs(const RowInputs& rows, const std::vector<double>& all, CaseResult& result) {
  result.inputs = rows.RowOf(all);
  result.inputs_digest = InputsDigest(all);
}

bool HasInputs(const RowInputs& rows, const std::vector<double>& all, const CaseResult& result) {
  const std::vector<double> row = rows.RowOf(all);
  return result.inputs.size() == row.size() &&
         std::memcmp(result.inputs.data(), row.data(), row.size() * sizeof(double)) == 0 &&
         result.inputs_digest == InputsDigest(all);
}

std::string NominalLoss(const CaseResult& nominal) {
  if (nominal.outcome == Outcome::kCompleted) return "";
  return fmt::format("The nominal flight itself is lost: {} at {:.2f} s in stage {}{}.",
                     OutcomeName(nominal.outcome), nominal.end_time_s, nominal.end_stage,
                     nominal.reason.empty() ? "" : " (" + nominal.reason + ")");
}

}  // namespace dispersa
