#include "services/transport/validity.h"

#include <algorithm>

#include "core/campaign_yaml/sha256.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"

namespace dispersa {
namespace {

constexpr std::size_t kMaxName = 256;
constexpr std::size_t kMaxClient = 80;  // a right, the name of its keys, 32 digits
constexpr std::size_t kMaxReason = 4096;
constexpr std::size_t kMaxList = 65536;
constexpr std::size_t kMaxCasesPerReport = 4096;
constexpr int kMaxStage = 64;

/// What a partition and a log may hold.
bool IsName(const std::string& text, std::size_t limit) {
  return !text.empty() && text.size() <= limit && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  });
}

std::string FirstOf(std::initializer_list<std::pair<bool, const char*>> problems) {
  for (const auto& [holds, what] : problems) {
    if (holds) return what;
  }
  return "";
}

const char kBadWorker[] = "the worker's name is no identifier";
const char kBadFlight[] = "the flight id is not 64 hexadecimal digits";

}  // namespace

std::string WhyInvalid(const WorkerStatus& status) {
  return FirstOf(
      {{!IsName(status.worker, 64), kBadWorker},
       {status.host.size() > kMaxName || status.engine_version.size() > kMaxName, "a text is too long"},
       {status.slots < 1 || status.slots > kMaxSlots, "slots are not from 1 to 1024"},
       {status.credits > kMaxList, "too many credits"},
       {status.held.size() > kMaxList || status.started.size() > kMaxList, "too long a list"}});
}

std::string WhyInvalid(const Orders& orders) {
  const bool flights = std::all_of(orders.assignments.begin(), orders.assignments.end(),
                                   [](const FlyOrder& order) { return IsSha256Hex(order.flight_id); });
  return FirstOf({{!IsName(orders.worker, 64), kBadWorker},
                  {orders.coordinator_epoch == 0, "the epoch is 0"},
                  {!flights, kBadFlight},
                  {orders.refusal.size() > kMaxReason, "a text is too long"}});
}

std::string WhyInvalid(const Report& report) {
  const auto has_sizes = [](const FlownCase& flown) {
    const std::size_t inputs = flown.result.inputs.size(), metrics = flown.result.metrics.size();
    if (flown.is_quarantined) return inputs == 0 && metrics == 0 && !flown.result.reason.empty();
    return inputs <= InputColumns().size() && metrics >= MetricCount(kUsualStages) &&
           metrics <= MetricCount(kMaxStages + kFurtherNozzles) + kMaxOwnMetrics;
  };
  const auto is_sane = [](const FlownCase& flown) {
    return flown.result.reason.size() <= kMaxReason && flown.result.end_stage >= 0 &&
           flown.result.end_stage <= kMaxStage;
  };
  return FirstOf({{!IsName(report.worker, 64), kBadWorker},
                  {!IsSha256Hex(report.flight_id), kBadFlight},
                  {report.flown.size() > kMaxCasesPerReport || report.started.size() > kMaxCasesPerReport,
                   "too many cases"},
                  {!std::all_of(report.flown.begin(), report.flown.end(), has_sizes),
                   "a result has not the inputs and metrics of this engine"},
                  {!std::all_of(report.flown.begin(), report.flown.end(), is_sane),
                   "a result has an impossible stage or reason"}});
}

std::string WhyInvalid(const TextRequest& request) {
  return FirstOf({{!IsName(request.worker, 64), kBadWorker}, {!IsSha256Hex(request.flight_id), kBadFlight}});
}

std::string WhyInvalid(const TextPart& part) {
  return FirstOf(
      {{!IsName(part.worker, 64), kBadWorker},
       {!IsSha256Hex(part.flight_id), kBadFlight},
       {part.name.size() > kMaxName || part.engine_version.size() > kMaxName, "a text is too long"},
       {part.size > kMaxTextBytes, "the campaign's text is larger than 64 MiB"},
       {part.offset > part.size || part.bytes.size() > part.size - part.offset, "a part beyond the text"}});
}

std::string WhyInvalid(const CampaignRefusal& refusal) {
  return FirstOf(
      {{!IsName(refusal.worker, 64), kBadWorker},
       {!IsSha256Hex(refusal.flight_id), kBadFlight},
       {refusal.reason.empty() || refusal.reason.size() > kMaxReason, "no reason, or too long a one"}});
}

std::string WhyInvalid(const CampaignProgress& progress) {
  return FirstOf({{!IsSha256Hex(progress.flight_id), kBadFlight}});
}

std::string WhyInvalid(const Request& request) {
  return FirstOf({{!IsName(request.client, kMaxClient), "the client's name is no identifier"},
                  {!IsName(request.method, 64), "the method is no identifier"},
                  {request.arguments.size() > kMaxReason, "too long arguments"}});
}

std::string WhyInvalid(const Reply& reply) {
  return FirstOf({{!IsName(reply.client, kMaxClient), "the client's name is no identifier"}});
}

}  // namespace dispersa
