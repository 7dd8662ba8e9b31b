#include "services/transport/coordinator_link.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "services/log/log.h"
#include "services/transport/convert.h"
#include "services/transport/doors.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/topics.h"
#include "services/transport/udp_port.h"

namespace dispersa {

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

  /// An event, and who said it.
  struct Heard {
    CoordinatorEvent event;
    std::string who;  ///< worker or client; empty: a participant that is gone
    int door;
  };

  struct Ports {
    std::uint16_t discovery, statuses;
  };

  /// Between now and their use another program may take them.
  static Ports FreePorts(const NetworkOptions& network) {
    const auto free_port = [&](int first, int last) {
      return FreeUdpPort(network.address, PortOf(network.domain, first), PortOf(network.domain, last));
    };
    return {free_port(kFirstDoorPort, kLastDoorPort - 1), free_port(kFirstDoorPort + 1, kLastDoorPort)};
  }

  /// One participant with its readers and writers.
  struct OpenDoor {
    OpenDoor(const NetworkOptions& network, const Door& door, const Ports& ports, EventQueue<Heard>& events)
        : participant({network, kCoordinatorParticipant, ports.discovery, {}, door}),
          publisher(participant.MakePublisher("")),
          subscriber(participant.MakeSubscriber({"", PartitionOf("*")})),
          progress(participant, publisher, kProgressTopic, 16),
          results(participant, publisher, kResultTopic) {
      const auto push = [&events, number = door.number](auto&& message, const std::string& sender) {
        std::string who = NameIn(message);
        if (!events.Push({{sender, std::move(message)}, std::move(who), number}))
          Complain("message", sender, "too many wait already");
      };
      reports.emplace(participant, subscriber, kReportTopic, push);
      text_requests.emplace(participant, subscriber, kTextRequestTopic, push);
      campaign_refusals.emplace(participant, subscriber, kCampaignRefusalTopic, push);
      requests.emplace(participant, subscriber, kRequestTopic, push);
      // Status messages have a socket of their own, so that they arrive even if many results wait in the
      // other one.
      statuses.emplace(
          participant, subscriber, kStatusTopic, push,
          [&events, number = door.number](const std::string& sender) {
            events.Push({{sender, SenderGone{}}, "", number});
          },
          MakeReaderQos(network.address, ports.statuses));
      for (const auto port : {ports.discovery, ports.statuses})
        if (door.doors->WasRefused(port))
          throw NetworkError("UDP port " + std::to_string(port) + " is not free");
    }

    Participant participant;
    dds::Publisher* publisher;
    dds::Subscriber* subscriber;
    std::map<std::string, std::unique_ptr<Channel>> channels;  ///< by worker or client
    Writer<idl::ProgressV1PubSubType> progress;
    Writer<idl::ResultV2PubSubType> results;
    std::optional<Reader<idl::ReportV3PubSubType>> reports;
    std::optional<Reader<idl::TextRequestV1PubSubType>> text_requests;
    std::optional<Reader<idl::CampaignRefusalV2PubSubType>> campaign_refusals;
    std::optional<Reader<idl::RequestV1PubSubType>> requests;
    std::optional<Reader<idl::WorkerStatusV2PubSubType>> statuses;
  };

  explicit Impl(const NetworkOptions& options)
      : network(options), doors(std::make_shared<Doors>(options.address, options.keys.has_value())) {
    Open();
  }

  void Open() {
    const Door door{doors, static_cast<int>(open.size())};
    const Ports ports = open.empty() ? Ports{CoordinatorPort(network.domain), StatusPort(network.domain)}
                                     : FreePorts(network);
    open.push_back(std::make_unique<OpenDoor>(network, door, ports, events));
    doors->Open(ports.discovery);
    if (pulse) pulse->Expect(static_cast<int>(open.size()));
  }

  /// Later, if it cannot be opened now.
  void OpenAnother() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_try) return;
    try {
      Open();
    } catch (const NetworkError& error) {
      LogWarning("no further participant can be made now: {}", error.what());
      next_try = now + std::chrono::seconds(1);
    }
  }

  /// Through the door at which it was heard last.
  Channel& ChannelTo(const std::string& who) {
    const auto found = routes.find(who);
    OpenDoor& door = *open[found == routes.end() ? 0 : static_cast<std::size_t>(found->second)];
    auto& channel = door.channels[who];
    if (!channel) channel = std::make_unique<Channel>(door.participant, who);
    return *channel;
  }

  void Forget(const std::string& who) {
    for (const auto& door : open) door->channels.erase(who);
    routes.erase(who);
  }

  NetworkOptions network;
  std::shared_ptr<Doors> doors;
  EventQueue<Heard> events;
  std::vector<std::unique_ptr<OpenDoor>> open;
  std::map<std::string, int> routes;  ///< doors, by worker or client
  std::shared_ptr<Pulse> pulse;
  std::chrono::steady_clock::time_point next_try = {};
};

CoordinatorLink::CoordinatorLink(const NetworkOptions& network) : impl_(std::make_unique<Impl>(network)) {}
CoordinatorLink::~CoordinatorLink() = default;

std::vector<CoordinatorEvent> CoordinatorLink::Wait(std::chrono::milliseconds timeout) {
  for (const auto& door : impl_->open) door->participant.LogSilent();
  if (impl_->doors->IsShort()) impl_->OpenAnother();
  std::vector<CoordinatorEvent> events;
  for (Impl::Heard& heard : impl_->events.Wait(timeout)) {
    if (!heard.who.empty()) {
      // A renewed connection may have come to another door.
      const auto [route, is_new] = impl_->routes.try_emplace(heard.who, heard.door);
      const bool asks_itself = impl_->pulse && heard.who == impl_->pulse->name();
      if (route->second != heard.door) {
        if (!asks_itself) impl_->open[static_cast<std::size_t>(route->second)]->channels.erase(heard.who);
        route->second = heard.door;
      }
      if (asks_itself) {
        if (const auto* question = std::get_if<Request>(&heard.event.what))
          Send(Reply{heard.who, question->number, 0, "{}", ""});
        continue;
      }
    }
    events.push_back(std::move(heard.event));
  }
  return events;
}

std::shared_ptr<const Pulse> CoordinatorLink::StartPulse() {
  impl_->pulse = std::make_shared<Pulse>(impl_->network);
  impl_->doors->OpenAllTo(impl_->pulse->prefix());
  impl_->pulse->Expect(static_cast<int>(impl_->open.size()));
  return impl_->pulse;
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

void CoordinatorLink::Forget(const std::string& who) { impl_->Forget(who); }

void CoordinatorLink::Publish(const CampaignProgress& progress) {
  for (const auto& door : impl_->open) door->progress.Write(ToIdl(progress));
}

void CoordinatorLink::Publish(const std::string& flight_id, const std::string& worker,
                              const FlownCase& flown) {
  for (const auto& door : impl_->open)
    if (door->results.matched() > 0) door->results.Write(ToIdl(flight_id, worker, flown));
}

bool CoordinatorLink::HasResultObservers() const {
  return std::any_of(impl_->open.begin(), impl_->open.end(),
                     [](const auto& door) { return door->results.matched() > 0; });
}

}  // namespace dispersa
