// A domain participant as all of ours are: UDP over IPv4 and nothing else. Internal to this folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include "services/transport/neighbours.h"
#include "services/transport/network.h"
#include "services/transport/sieve.h"
#include "services/transport/topics.h"

namespace dispersa {

struct ParticipantOptions {
  NetworkOptions network;
  std::string name;
  std::optional<std::uint16_t> discovery_port;  ///< fixed: a coordinator's
  std::vector<Peer> peers;                      ///< whom to announce ourselves to
  Door door = {};                               ///< a coordinator's
};

/// Owns the participant and everything made from it.
class Participant {
 public:
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Made on first use.
  template <typename PubSubType>
  eprosima::fastdds::dds::Topic* TopicOf(const std::string& name) {
    if (auto* topic = FindTopic(name)) return topic;
    using eprosima::fastdds::dds::TypeSupport;
    if constexpr (std::is_constructible_v<PubSubType, std::shared_ptr<const Seal>, std::string>) {
      return MakeTopic(name, TypeSupport(new PubSubType(IsForObservers(name) ? nullptr : seal_, name)));
    } else {
      return MakeTopic(name, TypeSupport(new PubSubType()));
    }
  }
  /// In a partition (an empty one: in none).
  eprosima::fastdds::dds::Publisher* MakePublisher(const std::string& partition);
  eprosima::fastdds::dds::Subscriber* MakeSubscriber(const std::vector<std::string>& partitions);

  /// Whether this writer of another participant is sure to speak for, or to, the worker or client of that
  /// name. Without keys nothing is sure, and all may.
  bool MaySpeakFor(const eprosima::fastrtps::rtps::InstanceHandle_t& writer, const std::string& name) const;

  /// Whether messages from here must be sealed.
  bool IsSealed() const { return seal_ != nullptr; }

  /// Now and then: see Neighbours.
  void LogSilent() { neighbours_.LogSilent(); }

  /// Number of participants that were found so far.
  long found() const { return neighbours_.found(); }
  ParticipantPrefix prefix() const;

  eprosima::fastdds::dds::DomainParticipant* get() { return participant_; }

 private:
  eprosima::fastdds::dds::Topic* FindTopic(const std::string& name);
  eprosima::fastdds::dds::Topic* MakeTopic(const std::string& name, eprosima::fastdds::dds::TypeSupport type);

  bool has_keys_;
  std::shared_ptr<const Seal> seal_;  ///< null: without secret
  Neighbours neighbours_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
};

}  // namespace dispersa
