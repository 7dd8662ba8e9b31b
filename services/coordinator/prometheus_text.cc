#include "services/coordinator/prometheus_text.h"

#include <fmt/format.h>

#include <map>

#include "services/transport/complaints.h"

namespace dispersa {

std::string PrometheusText(const Service& service, const Workforce& workforce) {
  std::map<std::string, int> states;
  LedgerProgress all;
  std::uint64_t conflicts = 0, slots = 0;
  for (const auto& [id, entry] : service.catalogue().entries()) {
    ++states[CampaignStateName(entry.state)];
    const LedgerProgress progress = service.View(id).progress;
    all.done += progress.done;
    all.waiting += progress.waiting;
    all.assigned += progress.assigned;
    all.quarantined += progress.quarantined;
    conflicts += entry.conflicts;
  }
  const std::vector<Dispatcher::WorkerView> workers = workforce.Workers();
  for (const Dispatcher::WorkerView& worker : workers) slots += worker.slots;

  std::string text = "# HELP dispersa_campaigns Campaigns by state.\n# TYPE dispersa_campaigns gauge\n";
  for (const auto& [state, count] : states)
    text += fmt::format("dispersa_campaigns{{state=\"{}\"}} {}\n", state, count);
  const auto put = [&text](const char* name, const char* type, const char* help, std::uint64_t value) {
    text += fmt::format("# HELP dispersa_{0} {1}\n# TYPE dispersa_{0} {2}\ndispersa_{0} {3}\n", name, help,
                        type, value);
  };
  put("cases_done", "gauge", "Cases with a result, of all campaigns.", all.done);
  put("cases_waiting", "gauge", "Cases that no worker has: the depth of the queue.", all.waiting);
  put("cases_assigned", "gauge", "Cases that workers have.", all.assigned);
  put("cases_quarantined", "gauge", "Cases that are quarantined.", all.quarantined);
  put("conflicts", "gauge", "Results that contradicted others.", conflicts);
  put("workers", "gauge", "Workers that are joined.", workers.size());
  put("slots", "gauge", "Threads of theirs that fly.", slots);
  put("audits_total", "counter", "Results that were flown again.", workforce.audits());
  put("expelled_total", "counter", "Keys, or workers without keys, that may not fly here any more.",
      workforce.expelled().size());
  put("refused_total", "counter", "Datagrams and messages that were refused.", Complaints());
  return text;
}

}  // namespace dispersa
