// Campaigns as the web application shows them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dispersa {

/// What the report says of one requirement.
struct RequirementOutcome {
  std::string metric;
  std::string words;  ///< "q_max_pa below 120000 for 99 % of flights at 10 % risk"
  double probability = 0.0;
  std::int64_t n = 0;
  std::int64_t failures = 0;
  std::optional<double> success_lower, success_upper;  ///< of the probability to meet it
  std::string verdict;                                 ///< that stands

  bool operator==(const RequirementOutcome&) const = default;
};

/// Of the completed flights of a campaign that flies.
struct LiveHistogram {
  std::string metric;
  std::uint64_t n = 0;
  double low = 0.0, width = 0.0;
  std::vector<double> counts;
  std::vector<double> limits;  ///< of its requirement
};

struct WorkerRow {
  std::string id;
  std::string host;
  std::string state;  ///< "ready", "flying", "draining", "left"
  int slots = 0;
  std::uint64_t flown = 0;  ///< cases
};

struct CampaignRow {
  std::string id;
  std::string name;
  std::string owner;  ///< empty: of an earlier version
  std::string state;  ///< "waiting", "flying", ...
  bool has_ended = false;
  std::string verdict;  ///< that stands, by its report
  std::string problem;
  std::string engine;
  std::string design_id;
  std::vector<std::string> labels;
  std::int64_t attempts = 0;
  std::uint64_t cases = 0;
  std::uint64_t done = 0;
  std::uint64_t quarantined = 0;
  std::uint64_t bytes = 0;
  int priority = 0;
  int code = 0;
  std::int64_t launched_unix_s = 0;
  std::int64_t ended_unix_s = 0;
  std::uint64_t order = 0;  ///< of launching
  double rate_per_s = 0.0;
  std::optional<double> eta_s;
  std::vector<RequirementOutcome> requirements;  ///< of a campaign that flies: so far
  std::vector<LiveHistogram> histograms;         ///< of key metrics, while it flies
};

/// All campaigns at one moment. It does not change, so many threads may read it.
class CampaignIndex {
 public:
  using Row = std::shared_ptr<const CampaignRow>;

  CampaignIndex() = default;
  /// In any order.
  explicit CampaignIndex(std::vector<Row> rows, std::vector<WorkerRow> workers = {});

  /// Those launched last come first.
  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<WorkerRow>& workers() const { return workers_; }
  /// The campaign whose id begins so, if it is exactly one.
  const CampaignRow* Find(const std::string& prefix) const;
  /// Rows with each word of `text` in id, name, owner, state, verdict or a label, in either case of letters.
  std::vector<const CampaignRow*> Search(const std::string& text) const;

 private:
  std::vector<Row> rows_;
  std::vector<WorkerRow> workers_;
  std::map<std::string, const CampaignRow*> by_id_;
};

}  // namespace dispersa
