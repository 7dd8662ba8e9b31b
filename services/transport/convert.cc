#include "services/transport/convert.h"

namespace dispersa {
namespace {

idl::FlownCaseV1 ToIdl(const FlownCase& flown) {
  const CaseResult& result = flown.result;
  idl::FlownCaseV1 message;
  message.case_index(result.case_index);
  message.attempt(flown.attempt);
  message.outcome(OutcomeName(result.outcome));
  message.end_time_s(result.end_time_s);
  message.end_stage(result.end_stage);
  message.reason(result.reason);
  message.inputs(result.inputs);
  message.metrics(result.metrics);
  message.digest_high(result.digest.high);
  message.digest_low(result.digest.low);
  return message;
}

bool FromIdl(const idl::FlownCaseV1& message, FlownCase* flown) {
  CaseResult& result = flown->result;
  result.case_index = message.case_index();
  flown->attempt = message.attempt();
  if (!ParseOutcome(message.outcome(), &result.outcome)) return false;
  result.end_time_s = message.end_time_s();
  result.end_stage = message.end_stage();
  result.reason = message.reason();
  result.inputs = message.inputs();
  result.metrics = message.metrics();
  result.digest = {message.digest_high(), message.digest_low()};
  return true;
}

}  // namespace

idl::WorkerStatusV1 ToIdl(const WorkerStatus& status) {
  idl::WorkerStatusV1 message;
  message.worker(status.worker);
  message.host(status.host);
  message.pid(status.pid);
  message.engine_version(status.engine_version);
  message.slots(status.slots);
  message.credits(status.credits);
  message.state(static_cast<idl::WorkerStateV1>(status.state));
  message.flown(status.flown);
  message.started_cases(status.started_cases);
  return message;
}

idl::CampaignV1 ToIdl(const CampaignDefinition& campaign) {
  idl::CampaignV1 message;
  message.coordinator_epoch(campaign.coordinator_epoch);
  message.campaign_id(campaign.campaign_id);
  message.flight_id(campaign.flight_id);
  message.engine_version(campaign.engine_version);
  message.name(campaign.name);
  message.canonical_yaml(campaign.canonical_yaml);
  return message;
}

idl::AssignmentV1 ToIdl(const FlyOrder& order) {
  idl::AssignmentV1 message;
  message.kind(idl::ASSIGNMENT_FLY_V1);
  message.coordinator_epoch(order.coordinator_epoch);
  message.flight_id(order.flight_id);
  message.attempt(order.attempt);
  message.case_indices(order.cases);
  return message;
}

idl::AssignmentV1 ToIdl(const LeaveOrder& order) {
  idl::AssignmentV1 message;
  message.kind(idl::ASSIGNMENT_LEAVE_V1);
  message.coordinator_epoch(order.coordinator_epoch);
  return message;
}

idl::ReportV1 ToIdl(const Report& report) {
  idl::ReportV1 message;
  message.worker(report.worker);
  message.coordinator_epoch(report.coordinator_epoch);
  message.flight_id(report.flight_id);
  message.flown().reserve(report.flown.size());
  for (const FlownCase& flown : report.flown) message.flown().push_back(ToIdl(flown));
  message.started().reserve(report.started.size());
  for (const StartedCase& started : report.started) {
    message.started().emplace_back();
    message.started().back().case_index(started.case_index);
    message.started().back().attempt(started.attempt);
  }
  return message;
}

idl::RefusalV1 ToIdl(const Refusal& refusal) {
  idl::RefusalV1 message;
  message.worker(refusal.worker);
  message.reason(refusal.reason);
  return message;
}

idl::CampaignRefusalV1 ToIdl(const CampaignRefusal& refusal) {
  idl::CampaignRefusalV1 message;
  message.worker(refusal.worker);
  message.coordinator_epoch(refusal.coordinator_epoch);
  message.flight_id(refusal.flight_id);
  message.reason(refusal.reason);
  return message;
}

WorkerStatus FromIdl(const idl::WorkerStatusV1& status) {
  return {status.worker(),
          status.host(),
          status.pid(),
          status.engine_version(),
          status.slots(),
          status.credits(),
          static_cast<WorkerState>(status.state()),
          status.flown(),
          status.started_cases()};
}

CampaignDefinition FromIdl(const idl::CampaignV1& campaign) {
  return {campaign.coordinator_epoch(), campaign.campaign_id(), campaign.flight_id(),
          campaign.engine_version(),    campaign.name(),        campaign.canonical_yaml()};
}

std::variant<FlyOrder, LeaveOrder> FromIdl(const idl::AssignmentV1& assignment) {
  if (assignment.kind() == idl::ASSIGNMENT_LEAVE_V1) return LeaveOrder{assignment.coordinator_epoch()};
  return FlyOrder{assignment.coordinator_epoch(), assignment.flight_id(), assignment.attempt(),
                  assignment.case_indices()};
}

std::optional<Report> FromIdl(const idl::ReportV1& report) {
  Report plain{report.worker(), report.coordinator_epoch(), report.flight_id(), {}, {}};
  plain.flown.resize(report.flown().size());
  for (std::size_t i = 0; i < plain.flown.size(); ++i) {
    if (!FromIdl(report.flown()[i], &plain.flown[i])) return std::nullopt;
  }
  for (const idl::StartedCaseV1& started : report.started()) {
    plain.started.push_back({started.case_index(), started.attempt()});
  }
  return plain;
}

Refusal FromIdl(const idl::RefusalV1& refusal) { return {refusal.worker(), refusal.reason()}; }

CampaignRefusal FromIdl(const idl::CampaignRefusalV1& refusal) {
  return {refusal.worker(), refusal.coordinator_epoch(), refusal.flight_id(), refusal.reason()};
}

}  // namespace dispersa
