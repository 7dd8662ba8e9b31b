#include "services/transport/worker_link.h"

#include <optional>
#include <utility>

#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/revocations.h"
#include "services/transport/topics.h"

namespace dispersa {
struct WorkerLink::Impl {
  struct Heard {
    std::string sender;
    WorkerEvent what;
  };

  Impl(const NetworkOptions& network, const std::vector<Peer>& peers, const std::string& worker)
      : participant({network, kWorkerParticipant, std::nullopt, peers}),
        publisher(participant.MakePublisher(PartitionOf(worker))),
        subscriber(participant.MakeSubscriber({PartitionOf(worker)})) {
    if (network.keys) revocations.emplace(*network.keys);
    // This includes messages of the coordinator to another worker that a third party repeats here.
    const auto push = [this, worker](auto&& message, const std::string& sender) {
      if (message.worker != worker) {
        Complain("message", sender, "it is for another worker");
      } else if (!events.Push({sender, std::move(message)}))
        Complain("message", sender, "too many wait already");
    };
    orders.emplace(participant, subscriber, kOrdersTopic, push);
    texts.emplace(participant, subscriber, kTextTopic, push);
    reports.emplace(participant, publisher, kReportTopic);
    text_requests.emplace(participant, publisher, kTextRequestTopic, 8);
    campaign_refusals.emplace(participant, publisher, kCampaignRefusalTopic, 8);
    statuses.emplace(participant, publisher, kStatusTopic, 1);
  }

  /// Those that are not of a coordinator with revoked keys.
  std::vector<WorkerEvent> Believed(std::vector<Heard> heard) {
    if (revocations) revocations->RefreshIfDue();
    std::vector<WorkerEvent> believed;
    for (Heard& each : heard) {
      if (revocations && revocations->IsOf(each.sender)) {
        Complain("message", each.sender, "the keys of this coordinator are revoked");
      } else {
        believed.push_back(std::move(each.what));
      }
    }
    return believed;
  }

  EventQueue<Heard> events;
  std::optional<Revocations> revocations;
  Participant participant;
  long met = 0;  ///< participants that the worker knows of
  dds::Publisher* publisher;
  dds::Subscriber* subscriber;
  std::optional<Writer<idl::ReportV3PubSubType>> reports;
  std::optional<Writer<idl::TextRequestV1PubSubType>> text_requests;
  std::optional<Writer<idl::CampaignRefusalV2PubSubType>> campaign_refusals;
  std::optional<Writer<idl::WorkerStatusV2PubSubType>> statuses;
  std::optional<Reader<idl::OrdersV1PubSubType>> orders;
  std::optional<Reader<idl::TextV1PubSubType>> texts;
};

WorkerLink::WorkerLink(const NetworkOptions& network, const std::vector<Peer>& peers,
                       const std::string& worker)
    : impl_(std::make_unique<Impl>(network, peers, worker)) {}
WorkerLink::~WorkerLink() = default;

std::vector<WorkerEvent> WorkerLink::Wait(std::chrono::milliseconds timeout) {
  impl_->participant.LogSilent();
  return impl_->Believed(impl_->events.Wait(timeout));
}

void WorkerLink::Send(const WorkerStatus& status) { impl_->statuses->Write(ToIdl(status)); }
void WorkerLink::Send(const Report& report) { impl_->reports->Write(ToIdl(report)); }
void WorkerLink::Send(const TextRequest& request) { impl_->text_requests->Write(ToIdl(request)); }
void WorkerLink::Send(const CampaignRefusal& refusal) { impl_->campaign_refusals->Write(ToIdl(refusal)); }

bool WorkerLink::HasMet() {
  const long found = impl_->participant.found();
  return std::exchange(impl_->met, found) != found;
}

void WorkerLink::Drain(std::chrono::milliseconds timeout) {
  const int each_ms = static_cast<int>(timeout.count());
  impl_->reports->Drain(each_ms);
  impl_->campaign_refusals->Drain(each_ms);
  impl_->statuses->Drain(each_ms);
}

}  // namespace dispersa
