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
  std::optional<double> bound = {};                    ///< in the metric's unit, see RequirementSummary
  std::vector<double> limits = {};                     ///< one, or of a range both

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

/// What a coordinator knows of a campaign and shows.
struct CampaignFacts {
  /// The campaign's. As an earlier engine flew it: "<id>-<digits of the engine>" (see find_by_id.h).
  std::string id;
  std::string name;
  int priority = 0;
  std::uint64_t order = 0;  ///< of launching
  std::uint64_t cases = 0;
  std::uint64_t done = 0;  ///< when it was last written
  std::uint64_t quarantined = 0;
  int code = 0;                      ///< exit code of a campaign that has ended
  std::string problem;               ///< of one that failed or was refused
  std::int64_t ended_unix_s = 0;     ///< when it ended (0: it has not)
  std::string owner;                 ///< name of keys, or local user; empty: of an earlier version
  std::int64_t launched_unix_s = 0;  ///< 0: by an earlier version
  std::uint64_t bytes = 0;           ///< on the disk, when they were last counted
  std::string verdict;               ///< that stands, by its report: "pass", "fail", ...
  std::vector<std::string> labels;   ///< "KEY=VALUE", the last given last
  std::string design_id;             ///< of campaigns that judge the same design
  std::string engine;                ///< that flies or flew it; empty: no case has been flown
  std::int64_t attempts = 0;         ///< at its design, this one too, by its report; 0: no report
  std::vector<RequirementOutcome> requirements;  ///< of its report; of a campaign that flies: so far

  bool operator==(const CampaignFacts&) const = default;
};

struct CampaignRow : CampaignFacts {
  std::string state;  ///< "waiting", "flying", ...
  bool has_ended = false;
  double rate_per_s = 0.0;
  std::optional<double> eta_s;
  std::vector<LiveHistogram> histograms;  ///< of key metrics, while it flies
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
