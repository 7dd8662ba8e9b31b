// A domain participant as all of ours are: UDP over IPv4 and nothing else. Internal to this folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include "services/transport/network.h"

namespace dispersa {

struct ParticipantOptions {
  NetworkOptions network;
  std::string name;
  std::optional<std::uint16_t> discovery_port;  ///< fixed: a coordinator's
  std::vector<Peer> peers;                      ///< whom to announce ourselves to
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
    return MakeTopic(name, eprosima::fastdds::dds::TypeSupport(new PubSubType()));
  }
  /// With a partition, or without if it is empty.
  eprosima::fastdds::dds::Publisher* MakePublisher(const std::string& partition);
  eprosima::fastdds::dds::Subscriber* MakeSubscriber(const std::string& partition);

  eprosima::fastdds::dds::DomainParticipant* get() { return participant_; }

 private:
  eprosima::fastdds::dds::Topic* FindTopic(const std::string& name);
  eprosima::fastdds::dds::Topic* MakeTopic(const std::string& name, eprosima::fastdds::dds::TypeSupport type);

  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
};

}  // namespace dispersa
