#include "services/transport/client_link.h"

#include <algorithm>

#include "services/transport/admission.h"
#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/event_queue.h"
#include "services/transport/topics.h"

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kFirstRepetition(50);
constexpr std::chrono::milliseconds kRepetition(1000);

}  // namespace

struct ClientLink::Impl {
  Impl(const NetworkOptions& network, const Peer& coordinator)
      : uuid(NameOnNetwork(network, MakeUuid())),
        participant({network, "dispersa-client", std::nullopt, {coordinator}}),
        requests(participant, participant.MakePublisher(PartitionOf(uuid)), kRequestTopic),
        replies(participant, participant.MakeSubscriber({PartitionOf(uuid)}), kReplyTopic,
                [this](Reply&& reply, const std::string&) { events.Push(std::move(reply)); }) {}

  std::string uuid;
  std::uint64_t number = 0;
  EventQueue<Reply> events;
  Participant participant;
  Writer<idl::RequestV1PubSubType> requests;
  Reader<idl::ReplyV1PubSubType> replies;
};

ClientLink::ClientLink(const NetworkOptions& network, const Peer& coordinator)
    : impl_(std::make_unique<Impl>(network, coordinator)) {}
ClientLink::~ClientLink() = default;

std::optional<Reply> ClientLink::Call(const std::string& method, const std::string& arguments,
                                      const std::string& data, std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const Request request{impl_->uuid, ++impl_->number, method, arguments, data};
  const auto deadline = Clock::now() + patience;
  // The first ones get lost when the two have not found each other yet.
  auto pause = kFirstRepetition;
  while (Clock::now() < deadline) {
    impl_->participant.LogSilent();
    impl_->requests.Write(ToIdl(request));
    const auto again = std::min(deadline, Clock::now() + pause);
    pause = std::min(2 * pause, kRepetition);
    while (Clock::now() < again) {
      const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(again - Clock::now());
      for (Reply& reply : impl_->events.Wait(wait + std::chrono::milliseconds(1))) {
        if (reply.number == request.number) return std::move(reply);
      }
    }
  }
  return std::nullopt;
}

}  // namespace dispersa
