#include "services/ledger/take_over.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/campaign/case_design.h"
#include "core/flight/flight_inputs.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

constexpr std::size_t kBatch = 1000;

// The worker of each case comes along with it. So the results of a forger are removed here, too.
class Fliers {
 public:
  explicit Fliers(const ResultFolder& folder) {
    folder.ForEachFlier([this](const std::string& worker, const std::string& host, std::uint64_t case_index) {
      const auto [known, is_new] = numbers_.try_emplace({worker, host}, fliers_.size());
      if (is_new) fliers_.emplace_back(worker, host);
      of_case_.emplace_back(case_index, known->second);
    });
    std::stable_sort(of_case_.begin(), of_case_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  ExecutionRecord Of(std::uint64_t case_index) const {
    const auto found =
        std::lower_bound(of_case_.begin(), of_case_.end(), std::pair(case_index, std::size_t{0}));
    const bool is_known = found != of_case_.end() && found->first == case_index;
    const auto& [worker, host] = is_known ? fliers_[found->second] : nobody_;
    return {case_index, worker, host, "", std::numeric_limits<double>::quiet_NaN()};
  }

 private:
  std::map<std::pair<std::string, std::string>, std::size_t> numbers_;
  std::vector<std::pair<std::string, std::string>> fliers_;  ///< worker, host
  std::vector<std::pair<std::uint64_t, std::size_t>> of_case_;
  std::pair<std::string, std::string> nobody_{kUnknownWorker, ""};
};

// Of the campaign's own metrics those at these places among the result's.
CaseResult WithOwnMetrics(const CaseResult& result, const MetricList& list,
                          const std::vector<std::size_t>& places) {
  const std::size_t of_vehicle = list.size() - list.own().size();
  CaseResult kept = result;
  kept.metrics.resize(of_vehicle);
  for (const std::size_t place : places) kept.metrics.push_back(result.metrics[of_vehicle + place]);
  return kept;
}

}  // namespace

TakenOver TakeOver(const ResultFolder& from, const Campaign& campaign,
                   const std::vector<std::string>& distrusted, ResultFolder& to) {
  const std::optional<std::vector<std::size_t>> own = FindOwn(campaign.own_metrics, from.own_metrics());
  if (!own) {
    LogInfo("{}: its results are not taken over: they lack metrics of the campaign {}",
            from.directory().string(), campaign.name);
    return {};
  }
  const CaseDesign design(campaign);
  const RowInputs rows(campaign);
  const Fliers fliers(from);
  std::vector<CaseResult> results;
  std::vector<ExecutionRecord> records;
  TakenOver taken;
  const auto store = [&] {
    to.Store(results, records);
    taken.results += results.size();
    results.clear();
    records.clear();
  };
  from.ForEach([&](const CaseResult& result) {
    if (result.case_index >= campaign.sampling.cases || to.Contains(result.case_index)) return;
    if (!HasInputs(rows, InputValues(design.Draw(result.case_index), rows.column_class()), result)) {
      ++taken.others;
      return;
    }
    ExecutionRecord record = fliers.Of(result.case_index);
    if (std::any_of(distrusted.begin(), distrusted.end(),
                    [&](const std::string& name) { return IsMeantBy(name, record.worker, record.host); }))
      return;
    results.push_back(WithOwnMetrics(result, from.metric_list(), *own));
    records.push_back(std::move(record));
    if (results.size() >= kBatch) store();
  });
  store();
  return taken;
}

}  // namespace dispersa
