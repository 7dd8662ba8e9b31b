#include "services/transport/convert.h"

namespace dispersa {
namespace {

/// In place of an outcome.
constexpr char kQuarantinedOutcome[] = "given_up";

std::vector<std::uint8_t> Octets(const std::string& bytes) { return {bytes.begin(), bytes.end()}; }
std::string Bytes(const std::vector<std::uint8_t>& octets) { return {octets.begin(), octets.end()}; }

idl::FlownCaseV3 ToIdl(const FlownCase& flown) {
  const CaseResult& result = flown.result;
  idl::FlownCaseV3 message;
  message.case_index(result.case_index);
  message.attempt(flown.attempt);
  message.outcome(flown.is_quarantined ? kQuarantinedOutcome : OutcomeName(result.outcome));
  message.end_time_s(result.end_time_s);
  message.end_stage(result.end_stage);
  message.reason(result.reason);
  message.inputs(result.inputs);
  message.inputs_digest_high(result.inputs_digest.high);
  message.inputs_digest_low(result.inputs_digest.low);
  message.metrics(result.metrics);
  message.digest_high(result.digest.high);
  message.digest_low(result.digest.low);
  return message;
}

bool FromIdl(const idl::FlownCaseV3& message, FlownCase* flown) {
  flown->is_quarantined = message.outcome() == kQuarantinedOutcome;
  CaseResult& result = flown->result;
  result.case_index = message.case_index();
  flown->attempt = message.attempt();
  if (!flown->is_quarantined && !ParseOutcome(message.outcome(), &result.outcome)) return false;
  result.end_time_s = message.end_time_s();
  result.end_stage = message.end_stage();
  result.reason = message.reason();
  result.inputs = message.inputs();
  result.inputs_digest = {message.inputs_digest_high(), message.inputs_digest_low()};
  result.metrics = message.metrics();
  result.digest = {message.digest_high(), message.digest_low()};
  return true;
}

std::vector<idl::StartedCaseV2> ToIdl(const std::vector<StartedCase>& started) {
  std::vector<idl::StartedCaseV2> messages(started.size());
  for (std::size_t i = 0; i < started.size(); ++i) {
    messages[i].case_index(started[i].case_index);
    messages[i].attempt(started[i].attempt);
  }
  return messages;
}

std::vector<StartedCase> FromIdl(const std::vector<idl::StartedCaseV2>& messages) {
  std::vector<StartedCase> started;
  for (const idl::StartedCaseV2& message : messages)
    started.push_back({message.case_index(), message.attempt()});
  return started;
}

}  // namespace

idl::WorkerStatusV2 ToIdl(const WorkerStatus& status) {
  idl::WorkerStatusV2 message;
  message.worker(status.worker);
  message.host(status.host);
  message.pid(status.pid);
  message.engine_version(status.engine_version);
  message.slots(status.slots);
  message.credits(status.credits);
  message.state(static_cast<idl::WorkerStateV2>(status.state));
  message.flown(status.flown);
  message.coordinator_epoch(status.coordinator_epoch);
  message.held(status.held);
  message.started(ToIdl(status.started));
  return message;
}

idl::OrdersV1 ToIdl(const Orders& orders) {
  idl::OrdersV1 message;
  message.worker(orders.worker);
  message.coordinator_epoch(orders.coordinator_epoch);
  message.assignments().resize(orders.assignments.size());
  for (std::size_t i = 0; i < orders.assignments.size(); ++i) {
    message.assignments()[i].flight_id(orders.assignments[i].flight_id);
    message.assignments()[i].attempt(orders.assignments[i].attempt);
    message.assignments()[i].case_indices(orders.assignments[i].cases);
  }
  message.revoked(orders.revoked);
  message.acknowledged(orders.acknowledged);
  message.leave(orders.leave);
  message.refusal(orders.refusal);
  return message;
}

idl::ReportV3 ToIdl(const Report& report) {
  idl::ReportV3 message;
  message.worker(report.worker);
  message.coordinator_epoch(report.coordinator_epoch);
  message.number(report.number);
  message.flight_id(report.flight_id);
  message.flown().reserve(report.flown.size());
  for (const FlownCase& flown : report.flown) message.flown().push_back(ToIdl(flown));
  message.started(ToIdl(report.started));
  return message;
}

idl::TextRequestV1 ToIdl(const TextRequest& request) {
  idl::TextRequestV1 message;
  message.worker(request.worker);
  message.flight_id(request.flight_id);
  message.offset(request.offset);
  return message;
}

idl::TextV1 ToIdl(const TextPart& part) {
  idl::TextV1 message;
  message.worker(part.worker);
  message.flight_id(part.flight_id);
  message.name(part.name);
  message.engine_version(part.engine_version);
  message.size(part.size);
  message.offset(part.offset);
  message.bytes(Octets(part.bytes));
  return message;
}

idl::CampaignRefusalV2 ToIdl(const CampaignRefusal& refusal) {
  idl::CampaignRefusalV2 message;
  message.worker(refusal.worker);
  message.coordinator_epoch(refusal.coordinator_epoch);
  message.flight_id(refusal.flight_id);
  message.reason(refusal.reason);
  message.engine_fault(refusal.engine_fault);
  return message;
}

idl::ProgressV1 ToIdl(const CampaignProgress& progress) {
  idl::ProgressV1 message;
  message.coordinator_epoch(progress.coordinator_epoch);
  message.campaign_id(progress.campaign_id);
  message.flight_id(progress.flight_id);
  message.name(progress.name);
  message.state(progress.state);
  message.total(progress.total);
  message.done(progress.done);
  message.quarantined(progress.quarantined);
  message.assigned(progress.assigned);
  message.workers(progress.workers);
  return message;
}

idl::ResultV2 ToIdl(const std::string& flight_id, const std::string& worker, const FlownCase& flown) {
  idl::ResultV2 message;
  message.flight_id(flight_id);
  message.worker(worker);
  message.flown(ToIdl(flown));
  return message;
}

idl::RequestV1 ToIdl(const Request& request) {
  idl::RequestV1 message;
  message.client(request.client);
  message.number(request.number);
  message.method(request.method);
  message.arguments(request.arguments);
  message.data(Octets(request.data));
  return message;
}

idl::ReplyV1 ToIdl(const Reply& reply) {
  idl::ReplyV1 message;
  message.client(reply.client);
  message.number(reply.number);
  message.code(reply.code);
  message.text(reply.text);
  message.data(Octets(reply.data));
  return message;
}

std::optional<WorkerStatus> FromIdl(const idl::WorkerStatusV2& status) {
  if (static_cast<std::uint32_t>(status.state()) > static_cast<std::uint32_t>(WorkerState::kLeft))
    return std::nullopt;
  return WorkerStatus{status.worker(),
                      status.host(),
                      status.pid(),
                      status.engine_version(),
                      status.slots(),
                      status.credits(),
                      static_cast<WorkerState>(status.state()),
                      status.flown(),
                      status.coordinator_epoch(),
                      status.held(),
                      FromIdl(status.started())};
}

std::optional<Orders> FromIdl(const idl::OrdersV1& orders) {
  Orders plain;
  plain.worker = orders.worker();
  plain.coordinator_epoch = orders.coordinator_epoch();
  for (const idl::AssignmentV2& assignment : orders.assignments()) {
    plain.assignments.push_back({assignment.flight_id(), assignment.attempt(), assignment.case_indices()});
  }
  plain.revoked = orders.revoked();
  plain.acknowledged = orders.acknowledged();
  plain.leave = orders.leave();
  plain.refusal = orders.refusal();
  return plain;
}

std::optional<Report> FromIdl(const idl::ReportV3& report) {
  Report plain{report.worker(), report.coordinator_epoch(), report.number(), report.flight_id(), {}, {}};
  plain.flown.resize(report.flown().size());
  for (std::size_t i = 0; i < plain.flown.size(); ++i) {
    if (!FromIdl(report.flown()[i], &plain.flown[i])) return std::nullopt;
  }
  plain.started = FromIdl(report.started());
  return plain;
}

std::optional<TextRequest> FromIdl(const idl::TextRequestV1& request) {
  return TextRequest{request.worker(), request.flight_id(), request.offset()};
}

std::optional<TextPart> FromIdl(const idl::TextV1& part) {
  return TextPart{part.worker(), part.flight_id(), part.name(),        part.engine_version(),
                  part.size(),   part.offset(),    Bytes(part.bytes())};
}

std::optional<CampaignRefusal> FromIdl(const idl::CampaignRefusalV2& refusal) {
  return CampaignRefusal{refusal.worker(), refusal.coordinator_epoch(), refusal.flight_id(), refusal.reason(),
                         refusal.engine_fault()};
}

std::optional<CampaignProgress> FromIdl(const idl::ProgressV1& progress) {
  return CampaignProgress{progress.coordinator_epoch(),
                          progress.campaign_id(),
                          progress.flight_id(),
                          progress.name(),
                          progress.state(),
                          progress.total(),
                          progress.done(),
                          progress.quarantined(),
                          progress.assigned(),
                          progress.workers()};
}

std::optional<Request> FromIdl(const idl::RequestV1& request) {
  return Request{request.client(), request.number(), request.method(), request.arguments(),
                 Bytes(request.data())};
}

std::optional<Reply> FromIdl(const idl::ReplyV1& reply) {
  return Reply{reply.client(), reply.number(), reply.code(), reply.text(), Bytes(reply.data())};
}

}  // namespace dispersa
