#include "services/transport/coordinator_link.h"

#include <spdlog/spdlog.h>

#include <map>
#include <mutex>
#include <optional>

#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/topics.h"

namespace dispersa {
namespace {

namespace dds = eprosima::fastdds::dds;

/// What is meant for one worker goes through writers of its own: a stopped worker blocks nobody else.
struct WorkerChannel {
  WorkerChannel(Participant& participant_, const std::string& worker)
      : participant(participant_),
        publisher(participant.MakePublisher(PartitionOf(worker))),
        assignments(std::in_place, participant, publisher, kAssignmentTopic),
        refusals(std::in_place, participant, publisher, kRefusalTopic) {}
  ~WorkerChannel() {
    assignments.reset();
    refusals.reset();
    participant.get()->delete_publisher(publisher);
  }

  Participant& participant;
  dds::Publisher* publisher;
  std::optional<Writer<idl::AssignmentV1PubSubType>> assignments;
  std::optional<Writer<idl::RefusalV1PubSubType>> refusals;
};

}  // namespace

struct CoordinatorLink::Impl {
  explicit Impl(const NetworkOptions& network)
      : participant({network, "dispersa-coordinator", CoordinatorPort(network.domain), {}}),
        publisher(participant.MakePublisher("")),
        subscriber(participant.MakeSubscriber("")) {
    reports.emplace(participant, subscriber, kReportTopic,
                    ReaderCallbacks<idl::ReportV1>{[this](const idl::ReportV1& message, const WriterHandle&) {
                      if (auto report = FromIdl(message)) {
                        events.Push(*std::move(report));
                      } else {
                        spdlog::error("worker {}: a result with an unknown outcome", message.worker());
                      }
                    }});
    campaign_refusals.emplace(participant, subscriber, kCampaignRefusalTopic,
                              ReaderCallbacks<idl::CampaignRefusalV1>{
                                  [this](const idl::CampaignRefusalV1& message, const WriterHandle&) {
                                    events.Push(FromIdl(message));
                                  }});
    statuses.emplace(participant, subscriber, kStatusTopic,
                     ReaderCallbacks<idl::WorkerStatusV1>{
                         [this](const idl::WorkerStatusV1& message, const WriterHandle& from) {
                           Remember(from, message.worker());
                           events.Push(FromIdl(message));
                         },
                         [this](const WriterHandle& from) {
                           if (const auto worker = Known(from)) events.Push(WorkerSilent{*worker});
                         },
                         [this](const WriterHandle& from) {
                           if (const auto worker = Known(from)) events.Push(WorkerGone{*worker});
                           const std::lock_guard lock(mutex);
                           worker_of.erase(from);
                         }},
                     Presence::kHeartbeat);
  }

  void Remember(const WriterHandle& from, const std::string& worker) {
    const std::lock_guard lock(mutex);
    worker_of[from] = worker;
  }
  std::optional<std::string> Known(const WriterHandle& from) {
    const std::lock_guard lock(mutex);
    const auto found = worker_of.find(from);
    return found == worker_of.end() ? std::nullopt : std::optional(found->second);
  }
  WorkerChannel& ChannelTo(const std::string& worker) {
    auto& channel = channels[worker];
    if (!channel) channel = std::make_unique<WorkerChannel>(participant, worker);
    return *channel;
  }

  EventQueue<CoordinatorEvent> events;
  std::mutex mutex;
  std::map<WriterHandle, std::string> worker_of;  ///< of a status writer

  Participant participant;
  dds::Publisher* publisher;
  dds::Subscriber* subscriber;
  std::map<std::string, std::unique_ptr<Writer<idl::CampaignV1PubSubType>>> campaigns;  ///< by flight id
  std::map<std::string, std::unique_ptr<WorkerChannel>> channels;                       ///< by worker
  std::optional<Reader<idl::ReportV1PubSubType>> reports;
  std::optional<Reader<idl::CampaignRefusalV1PubSubType>> campaign_refusals;
  std::optional<Reader<idl::WorkerStatusV1PubSubType>> statuses;
};

CoordinatorLink::CoordinatorLink(const NetworkOptions& network) : impl_(std::make_unique<Impl>(network)) {}
CoordinatorLink::~CoordinatorLink() = default;

std::vector<CoordinatorEvent> CoordinatorLink::Wait(std::chrono::milliseconds timeout) {
  return impl_->events.Wait(timeout);
}

void CoordinatorLink::OpenCampaign(const CampaignDefinition& campaign) {
  auto& writer = impl_->campaigns[campaign.flight_id];
  writer = std::make_unique<Writer<idl::CampaignV1PubSubType>>(impl_->participant, impl_->publisher,
                                                               kCampaignTopic);
  if (!writer->Write(ToIdl(campaign))) throw NetworkError("cannot publish the campaign");
}

void CoordinatorLink::CloseCampaign(const std::string& flight_id) { impl_->campaigns.erase(flight_id); }

void CoordinatorLink::Send(const std::string& worker, const FlyOrder& order) {
  if (!impl_->ChannelTo(worker).assignments->Write(ToIdl(order))) {
    // Nothing is lost: the lease of these cases will expire.
    spdlog::warn("worker {}: an assignment could not be sent", worker);
  }
}

void CoordinatorLink::Send(const std::string& worker, const LeaveOrder& order) {
  impl_->ChannelTo(worker).assignments->Write(ToIdl(order));
}

void CoordinatorLink::Refuse(const Refusal& refusal) {
  impl_->ChannelTo(refusal.worker).refusals->Write(ToIdl(refusal));
}

void CoordinatorLink::Drain(const std::string& worker, std::chrono::milliseconds timeout) {
  impl_->ChannelTo(worker).assignments->Drain(static_cast<int>(timeout.count()));
}

void CoordinatorLink::Forget(const std::string& worker) { impl_->channels.erase(worker); }

}  // namespace dispersa
