#include "services/transport/coordinator_link.h"

#include <map>
#include <optional>

#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/topics.h"

namespace dispersa {

namespace dds = eprosima::fastdds::dds;

struct CoordinatorLink::Impl {
  /// Messages to one participant have writers of their own, so that a stopped reader blocks no other.
  struct Channel {
    Channel(Participant& participant_, const std::string& who)
        : participant(participant_), publisher(participant.MakePublisher(PartitionOf(who))) {}
    ~Channel() {
      orders.reset();
      texts.reset();
      replies.reset();
      participant.get()->delete_publisher(publisher);
    }

    /// Made when first needed.
    template <typename PubSubType>
    Writer<PubSubType>& In(std::optional<Writer<PubSubType>>& writer, const std::string& topic) {
      if (!writer) writer.emplace(participant, publisher, topic);
      return *writer;
    }

    Participant& participant;
    dds::Publisher* publisher;
    std::optional<Writer<idl::OrdersV1PubSubType>> orders;
    std::optional<Writer<idl::TextV1PubSubType>> texts;
    std::optional<Writer<idl::ReplyV1PubSubType>> replies;
  };

  explicit Impl(const NetworkOptions& network)
      : participant({network, "dispersa-coordinator", CoordinatorPort(network.domain), {}}),
        publisher(participant.MakePublisher("")),
        subscriber(participant.MakeSubscriber({"", PartitionOf("*")})) {
    const auto push = [this](auto&& message, const std::string& sender) {
      if (!events.Push({sender, std::move(message)})) Complain("message", sender, "too many wait already");
    };
    reports.emplace(participant, subscriber, kReportTopic, push);
    text_requests.emplace(participant, subscriber, kTextRequestTopic, push);
    campaign_refusals.emplace(participant, subscriber, kCampaignRefusalTopic, push);
    requests.emplace(participant, subscriber, kRequestTopic, push);
    // Status messages have a socket of their own, so that they arrive even if many results wait in the other
    // one.
    statuses.emplace(
        participant, subscriber, kStatusTopic, push,
        [this](const std::string& sender) {
          events.Push({sender, SenderGone{}});
        },
        MakeReaderQos(network.address, StatusPort(network.domain)));
    progress.emplace(participant, publisher, kProgressTopic, 16);
    results.emplace(participant, publisher, kResultTopic);
  }

  Channel& ChannelTo(const std::string& who) {
    auto& channel = channels[who];
    if (!channel) channel = std::make_unique<Channel>(participant, who);
    return *channel;
  }

  EventQueue<CoordinatorEvent> events;
  Participant participant;
  dds::Publisher* publisher;
  dds::Subscriber* subscriber;
  std::map<std::string, std::unique_ptr<Channel>> channels;  ///< by worker or client
  std::optional<Writer<idl::ProgressV1PubSubType>> progress;
  std::optional<Writer<idl::ResultV1PubSubType>> results;
  std::optional<Reader<idl::ReportV2PubSubType>> reports;
  std::optional<Reader<idl::TextRequestV1PubSubType>> text_requests;
  std::optional<Reader<idl::CampaignRefusalV1PubSubType>> campaign_refusals;
  std::optional<Reader<idl::RequestV1PubSubType>> requests;
  std::optional<Reader<idl::WorkerStatusV2PubSubType>> statuses;
};

CoordinatorLink::CoordinatorLink(const NetworkOptions& network) : impl_(std::make_unique<Impl>(network)) {}
CoordinatorLink::~CoordinatorLink() = default;

std::vector<CoordinatorEvent> CoordinatorLink::Wait(std::chrono::milliseconds timeout) {
  impl_->participant.LogSilent();
  return impl_->events.Wait(timeout);
}

void CoordinatorLink::Send(const Orders& orders) {
  Impl::Channel& channel = impl_->ChannelTo(orders.worker);
  channel.In(channel.orders, kOrdersTopic).Write(ToIdl(orders));
}

void CoordinatorLink::Send(const TextPart& part) {
  Impl::Channel& channel = impl_->ChannelTo(part.worker);
  channel.In(channel.texts, kTextTopic).Write(ToIdl(part));
}

void CoordinatorLink::Send(const Reply& reply) {
  Impl::Channel& channel = impl_->ChannelTo(reply.client);
  channel.In(channel.replies, kReplyTopic).Write(ToIdl(reply));
}

void CoordinatorLink::Drain(const std::string& worker, std::chrono::milliseconds timeout) {
  if (auto& orders = impl_->ChannelTo(worker).orders) orders->Drain(static_cast<int>(timeout.count()));
}

void CoordinatorLink::Forget(const std::string& who) { impl_->channels.erase(who); }

void CoordinatorLink::Publish(const CampaignProgress& progress) { impl_->progress->Write(ToIdl(progress)); }

void CoordinatorLink::Publish(const std::string& flight_id, const std::string& worker,
                              const FlownCase& flown) {
  impl_->results->Write(ToIdl(flight_id, worker, flown));
}

bool CoordinatorLink::HasResultObservers() const { return impl_->results->matched() > 0; }

}  // namespace dispersa
