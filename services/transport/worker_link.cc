#include "services/transport/worker_link.h"

#include <spdlog/spdlog.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/topics.h"

namespace dispersa {
namespace {

namespace dds = eprosima::fastdds::dds;

constexpr std::chrono::seconds kBeat(kHeartbeatLeaseSeconds / 3);
static_assert(kBeat.count() >= 1);

}  // namespace

struct WorkerLink::Impl {
  Impl(const NetworkOptions& network, const Peer& peer, const std::string& worker)
      : participant({network, "dispersa-worker", std::nullopt, {peer}}),
        publisher(participant.MakePublisher("")),
        subscriber(participant.MakeSubscriber("")),
        own_subscriber(participant.MakeSubscriber(PartitionOf(worker))) {
    // A campaign has a writer of its own, which goes when the campaign closes.
    campaigns.emplace(participant, subscriber, kCampaignTopic,
                      ReaderCallbacks<idl::CampaignV1>{
                          [this](const idl::CampaignV1& message, const WriterHandle& from) {
                            const std::lock_guard lock(mutex);
                            campaign_of[from] = {message.coordinator_epoch(), message.flight_id()};
                            events.Push(FromIdl(message));
                          },
                          {},
                          [this](const WriterHandle& from) {
                            const std::lock_guard lock(mutex);
                            const auto found = campaign_of.find(from);
                            if (found == campaign_of.end()) return;
                            events.Push(found->second);
                            campaign_of.erase(found);
                          }});
    assignments.emplace(
        participant, own_subscriber, kAssignmentTopic,
        ReaderCallbacks<idl::AssignmentV1>{[this](const idl::AssignmentV1& message, const WriterHandle&) {
          std::visit([this](auto&& order) { events.Push(std::forward<decltype(order)>(order)); },
                     FromIdl(message));
        }});
    refusals.emplace(
        participant, own_subscriber, kRefusalTopic,
        ReaderCallbacks<idl::RefusalV1>{
            [this](const idl::RefusalV1& message, const WriterHandle&) { events.Push(FromIdl(message)); }});
    reports.emplace(participant, publisher, kReportTopic);
    campaign_refusals.emplace(participant, publisher, kCampaignRefusalTopic);
    statuses.emplace(participant, publisher, kStatusTopic, Presence::kHeartbeat);
    heart = std::jthread([this](std::stop_token stop) {
      std::mutex alone;
      std::condition_variable_any pause;
      std::unique_lock lock(alone);
      while (!stop.stop_requested()) {
        statuses->Beat();
        pause.wait_for(lock, stop, kBeat, [] { return false; });
      }
    });
  }

  EventQueue<WorkerEvent> events;
  std::mutex mutex;
  std::map<WriterHandle, CampaignClosed> campaign_of;  ///< by campaign writer
  Participant participant;
  dds::Publisher* publisher;
  dds::Subscriber* subscriber;
  dds::Subscriber* own_subscriber;
  std::optional<Reader<idl::CampaignV1PubSubType>> campaigns;
  std::optional<Reader<idl::AssignmentV1PubSubType>> assignments;
  std::optional<Reader<idl::RefusalV1PubSubType>> refusals;
  std::optional<Writer<idl::ReportV1PubSubType>> reports;
  std::optional<Writer<idl::CampaignRefusalV1PubSubType>> campaign_refusals;
  std::optional<Writer<idl::WorkerStatusV1PubSubType>> statuses;
  std::jthread heart;
};

WorkerLink::WorkerLink(const NetworkOptions& network, const Peer& peer, const std::string& worker)
    : impl_(std::make_unique<Impl>(network, peer, worker)) {}
WorkerLink::~WorkerLink() = default;

std::vector<WorkerEvent> WorkerLink::Wait(std::chrono::milliseconds timeout) {
  return impl_->events.Wait(timeout);
}

void WorkerLink::Wake() { impl_->events.Push(Wakened{}); }

void WorkerLink::Send(const WorkerStatus& status) { impl_->statuses->Write(ToIdl(status)); }

void WorkerLink::Send(const Report& report) {
  // A full history ends when the coordinator acknowledges; until then there is nothing better to do.
  while (!impl_->reports->Write(ToIdl(report))) spdlog::warn("a report could not be sent yet");
}

void WorkerLink::Send(const CampaignRefusal& refusal) { impl_->campaign_refusals->Write(ToIdl(refusal)); }

void WorkerLink::Drain(std::chrono::milliseconds timeout) {
  impl_->reports->Drain(static_cast<int>(timeout.count()));
}

}  // namespace dispersa
