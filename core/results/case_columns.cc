#include "core/results/case_columns.h"

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/metric_catalogue.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

/// Takes rows on a thread of its own while the next ones are read.
class RowsBeside {
 public:
  explicit RowsBeside(std::function<void(const CaseResult&)> take) : take_(std::move(take)) {}

  void Add(const CaseResult& result) {
    rows_.push_back(result);
    if (rows_.size() == kTogether) HandOver();
  }
  void Finish() {
    HandOver();
    taking_.get();
  }

 private:
  static constexpr std::size_t kTogether = 256;

  void HandOver() {
    if (taking_.valid()) taking_.get();
    taking_ = std::async(std::launch::async, [this, rows = std::exchange(rows_, {})] {
      for (const CaseResult& row : rows) take_(row);
    });
  }

  std::function<void(const CaseResult&)> take_;
  std::vector<CaseResult> rows_;
  std::future<void> taking_;
};

void EachOf(const ResultFolder& folder, const std::function<void(const CaseResult&)>& take, int threads) {
  if (threads <= 1) return folder.ForEach(take);
  RowsBeside rows(take);
  folder.ForEach([&rows](const CaseResult& result) { rows.Add(result); });
  rows.Finish();
}

}  // namespace

CaseColumns ReadColumns(const ResultFolder& folder, const std::vector<int>& wanted_inputs,
                        const std::function<void(const CaseResult&)>& observe, int threads) {
  CaseColumns cases;
  const std::size_t metrics = folder.metric_list().size();
  std::vector<std::size_t> places;  // in the rows, of the inputs that they hold
  for (const int input : wanted_inputs)
    if (const auto place = folder.inputs().PlaceOf(static_cast<std::size_t>(input))) places.push_back(*place);
  cases.own_metrics = folder.metric_list().own();
  const auto file = std::make_shared<ColumnFile>(folder.directory(), metrics + places.size());
  std::vector<double> row(metrics + places.size()), seen(SeenEvent::kValues.size());
  Digest first;
  const auto take = [&](const CaseResult& result) {
    if (observe) observe(result);
    if (cases.index.empty()) first = result.digest;
    cases.are_alike = (cases.index.size() == 1 || cases.are_alike) && result.digest == first;
    cases.index.push_back(result.case_index);
    cases.outcome.push_back(result.outcome);
    if (result.outcome != Outcome::kCompleted && cases.lost_flights.size() < kListedLostFlights) {
      cases.lost_flights.push_back(
          {result.case_index, result.outcome, result.end_time_s, result.end_stage, result.reason});
    }
    std::copy(result.metrics.begin(), result.metrics.end(), row.begin());
    for (std::size_t i = 0; i < places.size(); ++i) row[metrics + i] = result.inputs[places[i]];
    file->Append(row);
    for (const SeenEvent& event : result.events) {
      auto of = std::find_if(cases.events.begin(), cases.events.end(),
                             [&](const CaseColumns::Event& known) { return known.name == event.name; });
      if (of == cases.events.end())
        of = cases.events.insert(
            of, {event.name, std::make_shared<ColumnFile>(folder.directory(), SeenEvent::kValues.size())});
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = event.*SeenEvent::kValues[i];
      of->values->Append(seen);
    }
  };
  EachOf(folder, take, threads);
  cases.metrics.resize(metrics);
  for (const std::size_t i : folder.metrics()) cases.metrics[i] = CaseColumn(file, i);
  cases.inputs.resize(InputCount(folder.stages()));
  std::size_t column = metrics;
  for (const int input : wanted_inputs) {
    const auto position = static_cast<std::size_t>(input);
    cases.inputs[position] = folder.inputs().PlaceOf(position)
                                 ? CaseColumn(file, column++)
                                 : CaseColumn(cases.rows(), folder.inputs().constant(position));
  }
  return cases;
}

std::vector<double> MeasuredValues(const CaseColumns& cases, const std::string& metric) {
  const auto own = std::find(cases.own_metrics.begin(), cases.own_metrics.end(), metric);
  const std::size_t column =
      own == cases.own_metrics.end()
          ? MetricColumn(metric)
          : cases.metrics.size() - static_cast<std::size_t>(cases.own_metrics.end() - own);
  // The metric belongs to a stage that the vehicle does not have, or to another control law.
  if (column >= cases.metrics.size() || cases.metrics[column].empty())
    return std::vector<double>(cases.rows(), kUndefined);
  return cases.metrics[column];
}

std::vector<double> CompletedValues(const CaseColumns& cases, const std::string& metric) {
  std::vector<double> values = MeasuredValues(cases, metric);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted) values[i] = kUndefined;
  }
  return Unwrapped(std::move(values), CircleOf(metric));
}

std::size_t LostCount(const CaseColumns& cases) {
  return static_cast<std::size_t>(
      std::count_if(cases.outcome.begin(), cases.outcome.end(),
                    [](Outcome outcome) { return outcome != Outcome::kCompleted; }));
}

}  // namespace dispersa
