// A service's workers without a network: the real dispatcher with made-up time, and workers with made-up
// results.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/coordinator/workforce.h"
#include "tests/nominal_inputs.h"

namespace dispersa {

class MadeUpWorkforce : public Workforce {
 public:
  void BeginCampaign(CampaignBook& book, int priority) override {
    books_[book.campaign().flight_id] = &book;
    dispatcher.BeginCampaign(book, priority);
  }
  void EndCampaign(const std::string& flight_id) override {
    books_.erase(flight_id);
    dispatcher.EndCampaign(flight_id);
  }
  void Publish(CampaignProgress progress) override { published.push_back(std::move(progress)); }
  std::vector<Dispatcher::WorkerView> Workers() const override { return dispatcher.Workers(); }
  std::optional<std::string> RefusalByAll(const std::string& flight_id) const override {
    return dispatcher.RefusalByAll(flight_id);
  }
  const AuditOptions& audit() const override { return dispatcher.audit(); }
  std::uint64_t audits() const override { return dispatcher.audits(); }
  const ExpulsionMap& expelled() const override { return dispatcher.expelled(); }
  void Expel(const ExpulsionMap& names) override { dispatcher.Expel(names, false); }
  std::vector<std::string> Readmit(const std::string& name) override { return dispatcher.Readmit(name); }
  double now_s() const override { return time_s; }

  void Join(const std::string& worker, std::uint32_t slots = 1) {
    dispatcher.On(
        worker,
        WorkerStatus{
            worker, "host", 1, EngineVersion(), slots, 2 * slots, WorkerState::kReady, 0, kEpoch, {}, {}},
        time_s);
  }
  /// The assignments that are said to workers now.
  std::vector<FlyOrder> Tick() {
    std::vector<FlyOrder> all;
    for (const Orders& orders : dispatcher.Tick(time_s))
      all.insert(all.end(), orders.assignments.begin(), orders.assignments.end());
    return all;
  }
  static std::uint64_t CasesIn(const std::vector<FlyOrder>& orders) {
    std::uint64_t cases = 0;
    for (const FlyOrder& order : orders) cases += order.cases.size();
    return cases;
  }
  /// A result that came, whomever the case was given to.
  void Return(const std::string& worker, const std::string& flight_id, const CaseResult& result) {
    if (const auto book = books_.find(flight_id); book != books_.end())
      book->second->Accept(worker, "host", 0, result, time_s);
  }
  /// Of smoke.yaml.
  static CaseResult ResultOf(std::uint64_t case_index) {
    CaseResult result;
    result.case_index = case_index;
    result.outcome = Outcome::kCompleted;
    static const RowInputs rows(LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml"));
    ApplyEverywhere(rows, 0.5, result);
    result.metrics.assign(MetricCount(kUsualStages), 0.25);
    return result;
  }

  static constexpr std::uint64_t kEpoch = 7;
  Dispatcher dispatcher{kEpoch, EngineVersion()};
  double time_s = 1.0;
  std::vector<CampaignProgress> published;

 private:
  std::map<std::string, CampaignBook*> books_;  ///< by flight id
};

}  // namespace dispersa
