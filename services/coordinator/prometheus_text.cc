#include "services/coordinator/prometheus_text.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "core/input/printable.h"
#include "services/transport/complaints.h"

namespace dispersa {
namespace {

// A monitor keeps a series for each: those that come first in the queue.
constexpr std::size_t kMostCampaigns = 100;

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : Printable(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

class Figures {
 public:
  void Head(const char* name, const char* type, const char* help) {
    text_ += fmt::format("# HELP dispersa_{0} {1}\n# TYPE dispersa_{0} {2}\n", name, help, type);
  }
  template <typename Number>
  void Line(const std::string& name_and_labels, Number value) {
    text_ += fmt::format("dispersa_{} {}\n", name_and_labels, value);
  }
  template <typename Number>
  void Put(const char* name, const char* type, const char* help, Number value) {
    Head(name, type, help);
    Line(name, value);
  }
  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

// Those that have not ended.
void PutCampaigns(Figures& figures, const std::vector<CampaignView>& views) {
  const auto labels = [](const CampaignView& view) {
    return fmt::format("campaign=\"{}\",name={},owner={}", view.entry->id.substr(0, 12),
                       Quoted(view.entry->name), Quoted(view.entry->owner));
  };
  figures.Head("campaign_cases", "gauge", "Cases of a campaign that has not ended, by state.");
  for (const CampaignView& view : views) {
    const LedgerProgress& progress = view.progress;
    for (const auto& [state, cases] :
         {std::pair("done", progress.done), std::pair("waiting", progress.waiting),
          std::pair("assigned", progress.assigned), std::pair("quarantined", progress.quarantined)})
      figures.Line(fmt::format("campaign_cases{{{},state=\"{}\"}}", labels(view), state), cases);
  }
  figures.Head("campaign_results_per_second", "gauge", "New results of a campaign, over the last 10 s.");
  for (const CampaignView& view : views)
    figures.Line(fmt::format("campaign_results_per_second{{{}}}", labels(view)), view.rate_per_s);
  figures.Head("campaign_disk_bytes", "gauge", "Bytes of a campaign's folder.");
  for (const CampaignView& view : views)
    figures.Line(fmt::format("campaign_disk_bytes{{{}}}", labels(view)), view.entry->bytes);
}

}  // namespace

std::string PrometheusText(const Service& service, const Workforce& workforce, const ServingTimes& times) {
  std::map<std::string, int> states;
  LedgerProgress all;
  std::uint64_t conflicts = 0, slots = 0, bytes = 0;
  double rate_per_s = 0.0;
  std::vector<CampaignView> shown;
  for (const std::string& id : service.catalogue().InOrder()) {
    const CatalogueEntry& entry = service.catalogue().entries().at(id);
    ++states[CampaignStateName(entry.state)];
    conflicts += entry.conflicts;
    bytes += entry.bytes;
    if (HasEnded(entry.state)) {
      all.done += entry.done;
      all.quarantined += entry.quarantined;
      continue;
    }
    CampaignView view = service.View(id);
    all.done += view.progress.done;
    all.waiting += view.progress.waiting;
    all.assigned += view.progress.assigned;
    all.quarantined += view.progress.quarantined;
    rate_per_s += view.rate_per_s;
    if (shown.size() < kMostCampaigns) shown.push_back(std::move(view));
  }
  const std::vector<Dispatcher::WorkerView> workers = workforce.Workers();
  for (const Dispatcher::WorkerView& worker : workers) slots += worker.slots;

  Figures figures;
  figures.Head("campaigns", "gauge", "Campaigns by state.");
  for (const auto& [state, count] : states)
    figures.Line(fmt::format("campaigns{{state=\"{}\"}}", state), count);
  figures.Put("cases_done", "gauge", "Cases with a result, of all campaigns.", all.done);
  figures.Put("cases_waiting", "gauge", "Cases that no worker has: the depth of the queue.", all.waiting);
  figures.Put("cases_assigned", "gauge", "Cases that workers have.", all.assigned);
  figures.Put("cases_quarantined", "gauge", "Cases that are quarantined.", all.quarantined);
  figures.Put("results_per_second", "gauge", "New results of all campaigns, over the last 10 s.", rate_per_s);
  figures.Put("conflicts", "gauge", "Results that contradicted others.", conflicts);
  figures.Put("workers", "gauge", "Workers that are joined.", workers.size());
  figures.Put("slots", "gauge", "Threads of theirs that fly.", slots);
  figures.Put("reports_writing", "gauge", "Campaigns whose report is being written.",
              service.reports_under_way());
  figures.Put("reports_waiting", "gauge", "Campaigns that wait for their report.", service.reports_waiting());
  figures.Put("report_wait_seconds", "gauge", "Time for which the first of them has waited.",
              service.report_wait_s());
  figures.Put("disk_bytes", "gauge", "Bytes of all campaigns' folders.", bytes);
  if (const auto free = service.free_bytes())
    figures.Put("disk_free_bytes", "gauge", "Bytes that are free on the disk of the campaigns.", *free);
  figures.Head("request_seconds", "summary", "Time of an answer to a client.");
  figures.Line("request_seconds_sum", times.requests_s);
  figures.Line("request_seconds_count", times.requests);
  figures.Put("round_seconds_max", "gauge", "Longest round of the coordinator's loop in the last seconds.",
              times.longest_round_s);
  figures.Put("audits_total", "counter", "Results that were flown again.", workforce.audits());
  figures.Put("expelled", "gauge", "Processes, hosts and keys that may not fly here any more.",
              CountExpelled(workforce.expelled()));
  figures.Put("refused_total", "counter", "Datagrams and messages that were refused.", Complaints());
  PutCampaigns(figures, shown);
  return figures.Take();
}

}  // namespace dispersa
