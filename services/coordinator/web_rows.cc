#include "services/coordinator/web_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/input/printable.h"
#include "core/results/requirement_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

CampaignRow RowOf(const CatalogueEntry& entry) {
  CampaignRow row;
  static_cast<CampaignFacts&>(row) = entry;
  row.state = CampaignStateName(entry.state);
  row.has_ended = HasEnded(entry.state);
  return row;
}

/// A campaign that has ended changes only so: it is launched again, and so gets labels or another priority.
bool IsStill(const CampaignRow& row, const CatalogueEntry& entry) {
  return row.ended_unix_s == entry.ended_unix_s && row.state == CampaignStateName(entry.state) &&
         row.priority == entry.priority && row.labels == entry.labels && row.bytes == entry.bytes &&
         row.order == entry.order;
}

std::string WordsOf(const Requirement& requirement) {
  if (requirement.every_case) return LimitText(requirement) + " in every flight";
  return fmt::format("{} for {} of flights at {} risk", LimitText(requirement),
                     PercentText(requirement.probability), PercentText(requirement.consumer_risk));
}

/// Twice the cube root of their number (Rice's rule), so that few cases make no comb.
std::size_t BinsFor(std::int64_t n) {
  return std::clamp(static_cast<std::size_t>(2.0 * std::cbrt(static_cast<double>(n))), std::size_t{6},
                    RunningHistogram::kMaxBins);
}

LiveHistogram LiveOf(const MetricHistogram& histogram) {
  const HistogramBins bins = histogram.values.Bins(BinsFor(histogram.values.n()));
  LiveHistogram live{histogram.metric, static_cast<std::uint64_t>(histogram.values.n()), bins.low,
                     bins.width,       {bins.counts.begin(), bins.counts.end()},         {}};
  for (const double limit : {histogram.limits.low, histogram.limits.high})
    if (std::isfinite(limit)) live.limits.push_back(limit);
  return live;
}

CampaignRow RowOf(const CampaignView& view, const RunningTally* tally) {
  CampaignRow row = RowOf(*view.entry);
  row.problem = view.problem;
  row.done = view.progress.done;
  row.quarantined = view.progress.quarantined;
  row.cases = view.progress.total;
  row.rate_per_s = view.rate_per_s;
  row.eta_s = view.eta_s;
  row.requirements.clear();
  for (std::size_t i = 0; tally != nullptr && i < std::min(view.standings.size(), kMaxOutcomes); ++i) {
    const RequirementStanding& standing = view.standings[i];
    row.requirements.push_back({standing.metric, WordsOf(tally->requirements()[i]),
                                tally->requirements()[i].probability, standing.n, standing.failures,
                                std::nullopt, std::nullopt, standing.so_far});
  }
  if (tally != nullptr)
    for (const MetricHistogram& histogram : tally->histograms()) row.histograms.push_back(LiveOf(histogram));
  return row;
}

std::vector<WorkerRow> WorkersOf(const Workforce& workforce) {
  std::vector<WorkerRow> rows;
  for (const Dispatcher::WorkerView& worker : workforce.Workers())
    rows.push_back({worker.worker, Printable(worker.host), WorkerStateName(worker.state),
                    static_cast<int>(worker.slots), worker.flown});
  return rows;
}

}  // namespace

std::shared_ptr<const CampaignIndex> WebRows::Make(const Service& service, const Workforce& workforce) {
  std::map<std::string, CampaignIndex::Row> ended;
  std::vector<CampaignIndex::Row> rows;
  for (const auto& [id, entry] : service.catalogue().entries()) {
    if (!HasEnded(entry.state)) {
      rows.push_back(std::make_shared<CampaignRow>(RowOf(service.View(id), service.TallyOf(id))));
      continue;
    }
    CampaignIndex::Row& row = ended[id];
    if (const auto known = ended_.find(id); known != ended_.end() && IsStill(*known->second, entry))
      row = known->second;
    else
      row = std::make_shared<CampaignRow>(RowOf(entry));
    rows.push_back(row);
  }
  ended_ = std::move(ended);
  return std::make_shared<CampaignIndex>(std::move(rows), WorkersOf(workforce));
}

}  // namespace dispersa
