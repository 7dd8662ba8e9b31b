#include "services/ledger/open_book.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "services/ledger/campaign_attempt.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

/// Attempts of one opening: more than any has.
constexpr std::uint64_t kAttempts = std::uint64_t{1} << 40;
constexpr std::size_t kBatch = 1000;

bool HasResults(const fs::path& directory) {
  std::error_code error;
  return fs::is_regular_file(directory / "results.sqlite", error);
}

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

void TakeOver(const ResultFolder& from, const Campaign& campaign, const std::vector<std::string>& distrusted,
              ResultFolder& to) {
  const std::optional<std::vector<std::size_t>> own = FindOwn(campaign.own_metrics, from.own_metrics());
  if (!own) {
    LogInfo("{}: its results are not taken over: they lack metrics of the campaign {}",
            from.directory().string(), campaign.name);
    return;
  }
  const CaseDesign design(campaign);
  const RowInputs rows(campaign);
  const Fliers fliers(from);
  std::vector<CaseResult> results;
  std::vector<ExecutionRecord> records;
  const auto store = [&] {
    to.Store(results, records);
    results.clear();
    records.clear();
  };
  std::uint64_t others = 0;
  from.ForEach([&](const CaseResult& result) {
    if (result.case_index >= campaign.sampling.cases || to.Contains(result.case_index)) return;
    if (!HasInputs(rows, InputValues(design.Draw(result.case_index), rows.column_class()), result)) {
      ++others;
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
  if (others > 0) {
    LogWarning("{}: {} results are not taken over: their inputs are not those that the campaign draws",
               from.directory().string(), others);
  }
}

/// What others have flown saves time; what is wrong with their folders is no reason to fail.
void TryToTakeOver(const fs::path& from, const Campaign& campaign, const std::vector<std::string>& distrusted,
                   ResultFolder& to) {
  try {
    const ResultFolder folder = ResultFolder::Open(from);
    if (folder.Provenance("flight_id") == campaign.flight_id) TakeOver(folder, campaign, distrusted, to);
  } catch (const InputError& error) {
    LogWarning("{}: its results are not taken over: {}", from.string(), error.what());
  } catch (const ResultError& error) {
    if (error.kind() == ResultError::Kind::kDiskFull) throw;
    LogWarning("{}: its results are not taken over: {}", from.string(), error.what());
  }
}

}  // namespace

std::unique_ptr<CampaignBook> OpenBook(const BookRequest& opening) {
  const Campaign campaign = ParseCampaign(opening.text, opening.name);
  const bool is_new = !HasResults(opening.results);
  if (is_new) {
    // Of a start that was killed: nothing is in it.
    std::error_code error;
    fs::remove_all(opening.results, error);
  }
  ResultFolder folder = is_new ? ResultFolder::Create(opening.results, campaign)
                               : ResultFolder::Resume(opening.results, campaign);
  for (const std::uint64_t damaged : folder.damaged()) {
    LogWarning("{}: the row of case {} is damaged; it is flown again", opening.results.string(), damaged);
  }
  for (const std::string& worker : opening.distrusted) {
    const std::size_t removed = folder.Disown(worker).size();
    if (removed == 0) continue;
    LogWarning("{}: {} results of {} are removed; their cases are flown again", opening.results.string(),
               removed, worker);
  }
  BeginAttemptIn(opening.root, opening.results, campaign);
  // Each time: what a start that was killed did not take over is taken now. A campaign that stops by itself
  // takes none, because what it flies depends on its own looks alone.
  if (!campaign.verdicts.stop_when_decided) {
    for (const fs::path& other : opening.same_flights) {
      if (HasResults(other)) TryToTakeOver(other, campaign, opening.distrusted, folder);
    }
  }
  LedgerOptions options;
  options.attempt_base = opening.number * kAttempts;
  auto book = std::make_unique<CampaignBook>(campaign, std::move(folder), options);
  book->PauseOnDiskErrors();
  book->KeepTally();
  book->KeepAudit(opening.audit);
  return book;
}

}  // namespace dispersa
