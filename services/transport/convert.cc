#include "services/transport/convert.h"

#include <concepts>
#include <type_traits>

namespace dispersa {
namespace {

/// In place of an outcome.
constexpr char kQuarantinedOutcome[] = "given_up";

/// A plain message or its type on the wire, whichever of them is read.
template <typename Given, typename Type>
concept Is = std::same_as<std::remove_const_t<Given>, Type>;

// The members of each message, said once for both ways. `each` takes a member of both sides.
void Members(Is<StartedCase> auto& plain, Is<idl::StartedCaseV2> auto& wire, auto& each) {
  each(plain.case_index, wire.case_index());
  each(plain.attempt, wire.attempt());
}

void Members(Is<FlyOrder> auto& plain, Is<idl::AssignmentV2> auto& wire, auto& each) {
  each(plain.flight_id, wire.flight_id());
  each(plain.attempt, wire.attempt());
  each(plain.cases, wire.case_indices());
}

void Members(Is<SeenEvent> auto& plain, Is<idl::SeenEventV1> auto& wire, auto& each) {
  each.EventName(plain.name, wire.name());
  each(plain.time_s, wire.time_s());
  each(plain.altitude_m, wire.altitude_m());
  each(plain.speed_m_s, wire.speed_m_s());
  each(plain.qbar_pa, wire.qbar_pa());
  each(plain.mass_kg, wire.mass_kg());
}

void Members(Is<FlownCase> auto& plain, Is<idl::FlownCaseV3> auto& wire, auto& each) {
  each(plain.result.case_index, wire.case_index());
  each(plain.attempt, wire.attempt());
  each.Outcome(plain, wire);
  each(plain.result.end_time_s, wire.end_time_s());
  each(plain.result.end_stage, wire.end_stage());
  each(plain.result.reason, wire.reason());
  each(plain.result.inputs, wire.inputs());
  each(plain.result.inputs_digest.high, wire.inputs_digest_high());
  each(plain.result.inputs_digest.low, wire.inputs_digest_low());
  each(plain.result.metrics, wire.metrics());
  each(plain.result.digest.high, wire.digest_high());
  each(plain.result.digest.low, wire.digest_low());
  each(plain.result.events, wire.events());
}

void Members(Is<WorkerStatus> auto& plain, Is<idl::WorkerStatusV2> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.host, wire.host());
  each(plain.pid, wire.pid());
  each(plain.engine_version, wire.engine_version());
  each(plain.slots, wire.slots());
  each(plain.credits, wire.credits());
  each(plain.state, wire.state());
  each(plain.flown, wire.flown());
  each(plain.coordinator_epoch, wire.coordinator_epoch());
  each(plain.held, wire.held());
  each(plain.started, wire.started());
}

void Members(Is<Orders> auto& plain, Is<idl::OrdersV1> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.coordinator_epoch, wire.coordinator_epoch());
  each(plain.assignments, wire.assignments());
  each(plain.revoked, wire.revoked());
  each(plain.acknowledged, wire.acknowledged());
  each(plain.leave, wire.leave());
  each(plain.refusal, wire.refusal());
}

void Members(Is<Report> auto& plain, Is<idl::ReportV3> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.coordinator_epoch, wire.coordinator_epoch());
  each(plain.number, wire.number());
  each(plain.flight_id, wire.flight_id());
  each(plain.flown, wire.flown());
  each(plain.started, wire.started());
}

void Members(Is<TextRequest> auto& plain, Is<idl::TextRequestV1> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.flight_id, wire.flight_id());
  each(plain.offset, wire.offset());
}

void Members(Is<TextPart> auto& plain, Is<idl::TextV1> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.flight_id, wire.flight_id());
  each(plain.name, wire.name());
  each(plain.engine_version, wire.engine_version());
  each(plain.size, wire.size());
  each(plain.offset, wire.offset());
  each(plain.bytes, wire.bytes());
}

void Members(Is<CampaignRefusal> auto& plain, Is<idl::CampaignRefusalV2> auto& wire, auto& each) {
  each(plain.worker, wire.worker());
  each(plain.coordinator_epoch, wire.coordinator_epoch());
  each(plain.flight_id, wire.flight_id());
  each(plain.reason, wire.reason());
  each(plain.engine_fault, wire.engine_fault());
}

void Members(Is<CampaignProgress> auto& plain, Is<idl::ProgressV1> auto& wire, auto& each) {
  each(plain.coordinator_epoch, wire.coordinator_epoch());
  each(plain.campaign_id, wire.campaign_id());
  each(plain.flight_id, wire.flight_id());
  each(plain.name, wire.name());
  each(plain.state, wire.state());
  each(plain.total, wire.total());
  each(plain.done, wire.done());
  each(plain.quarantined, wire.quarantined());
  each(plain.assigned, wire.assigned());
  each(plain.workers, wire.workers());
}

void Members(Is<Request> auto& plain, Is<idl::RequestV1> auto& wire, auto& each) {
  each(plain.client, wire.client());
  each(plain.number, wire.number());
  each(plain.method, wire.method());
  each(plain.arguments, wire.arguments());
  each(plain.data, wire.data());
}

void Members(Is<Reply> auto& plain, Is<idl::ReplyV1> auto& wire, auto& each) {
  each(plain.client, wire.client());
  each(plain.number, wire.number());
  each(plain.code, wire.code());
  each(plain.text, wire.text());
  each(plain.data, wire.data());
}

/// Text and octets.
template <typename From, typename To>
concept IsOfBytes = sizeof(typename From::value_type) == 1 && sizeof(typename To::value_type) == 1;

struct ToWire {
  template <typename Plain, typename Wire>
  void operator()(const Plain& plain, Wire& wire) {
    if constexpr (std::is_enum_v<Wire>) {
      wire = static_cast<Wire>(plain);
    } else if constexpr (std::is_assignable_v<Wire&, const Plain&>) {
      wire = plain;
    } else if constexpr (IsOfBytes<Plain, Wire>) {
      wire.assign(plain.begin(), plain.end());
    } else {
      wire.resize(plain.size());
      for (std::size_t i = 0; i < plain.size(); ++i) Members(plain[i], wire[i], *this);
    }
  }
  void Outcome(const FlownCase& plain, idl::FlownCaseV3& wire) {
    wire.outcome(plain.is_quarantined ? kQuarantinedOutcome : OutcomeName(plain.result.outcome));
  }
  void EventName(const std::string& plain, std::string& wire) { wire = plain; }
};

struct FromWire {
  bool is_known = true;  ///< every enumerator and outcome; every event has the form of a name

  template <typename Plain, typename Wire>
  void operator()(Plain& plain, const Wire& wire) {
    if constexpr (std::is_enum_v<Wire>) {
      is_known = is_known && static_cast<std::uint32_t>(wire) <= static_cast<std::uint32_t>(Plain::kLeft);
      plain = static_cast<Plain>(wire);
    } else if constexpr (std::is_assignable_v<Plain&, const Wire&>) {
      plain = wire;
    } else if constexpr (IsOfBytes<Wire, Plain>) {
      plain.assign(wire.begin(), wire.end());
    } else {
      plain.resize(wire.size());
      for (std::size_t i = 0; i < wire.size(); ++i) Members(plain[i], wire[i], *this);
    }
  }
  void Outcome(FlownCase& plain, const idl::FlownCaseV3& wire) {
    plain.is_quarantined = wire.outcome() == kQuarantinedOutcome;
    is_known = is_known && (plain.is_quarantined || ParseOutcome(wire.outcome(), &plain.result.outcome));
  }
  void EventName(std::string& plain, const std::string& wire) {
    is_known = is_known && IsEventName(wire);
    plain = wire;
  }
};

template <typename Wire>
Wire Sent(const auto& plain) {
  Wire wire;
  ToWire each;
  Members(plain, wire, each);
  return wire;
}

template <typename Plain>
std::optional<Plain> Received(const auto& wire) {
  Plain plain;
  FromWire each;
  Members(plain, wire, each);
  return each.is_known ? std::optional(std::move(plain)) : std::nullopt;
}

}  // namespace

idl::WorkerStatusV2 ToIdl(const WorkerStatus& status) { return Sent<idl::WorkerStatusV2>(status); }
idl::OrdersV1 ToIdl(const Orders& orders) { return Sent<idl::OrdersV1>(orders); }
idl::ReportV3 ToIdl(const Report& report) { return Sent<idl::ReportV3>(report); }
idl::TextRequestV1 ToIdl(const TextRequest& request) { return Sent<idl::TextRequestV1>(request); }
idl::TextV1 ToIdl(const TextPart& part) { return Sent<idl::TextV1>(part); }
idl::CampaignRefusalV2 ToIdl(const CampaignRefusal& refusal) { return Sent<idl::CampaignRefusalV2>(refusal); }
idl::ProgressV1 ToIdl(const CampaignProgress& progress) { return Sent<idl::ProgressV1>(progress); }
idl::RequestV1 ToIdl(const Request& request) { return Sent<idl::RequestV1>(request); }
idl::ReplyV1 ToIdl(const Reply& reply) { return Sent<idl::ReplyV1>(reply); }

idl::ResultV2 ToIdl(const std::string& flight_id, const std::string& worker, const FlownCase& flown) {
  idl::ResultV2 message;
  message.flight_id(flight_id);
  message.worker(worker);
  message.flown(Sent<idl::FlownCaseV3>(flown));
  return message;
}

std::optional<WorkerStatus> FromIdl(const idl::WorkerStatusV2& status) {
  return Received<WorkerStatus>(status);
}
std::optional<Orders> FromIdl(const idl::OrdersV1& orders) { return Received<Orders>(orders); }
std::optional<Report> FromIdl(const idl::ReportV3& report) { return Received<Report>(report); }
std::optional<TextRequest> FromIdl(const idl::TextRequestV1& request) {
  return Received<TextRequest>(request);
}
std::optional<TextPart> FromIdl(const idl::TextV1& part) { return Received<TextPart>(part); }
std::optional<CampaignRefusal> FromIdl(const idl::CampaignRefusalV2& refusal) {
  return Received<CampaignRefusal>(refusal);
}
std::optional<CampaignProgress> FromIdl(const idl::ProgressV1& progress) {
  return Received<CampaignProgress>(progress);
}
std::optional<Request> FromIdl(const idl::RequestV1& request) { return Received<Request>(request); }
std::optional<Reply> FromIdl(const idl::ReplyV1& reply) { return Received<Reply>(reply); }

}  // namespace dispersa
