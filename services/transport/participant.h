// A domain participant as all of ours are: UDP over IPv4 and nothing else. Internal to this folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "services/transport/fast_dds.h"
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
  dds::Topic* TopicOf(const std::string& name) {
    if (auto* topic = FindTopic(name)) return topic;
    if constexpr (std::is_constructible_v<PubSubType, std::shared_ptr<const Seal>, std::string>) {
      return MakeTopic(name, dds::TypeSupport(new PubSubType(IsForObservers(name) ? nullptr : seal_, name)));
    } else {
      return MakeTopic(name, dds::TypeSupport(new PubSubType()));
    }
  }
  /// In a partition (an empty one: in none).
  dds::Publisher* MakePublisher(const std::string& partition);
  dds::Subscriber* MakeSubscriber(const std::vector<std::string>& partitions);

  /// Whether this writer of another participant is sure to speak for, or to, the worker or client of that
  /// name. Without keys nothing is sure, and all may.
  bool MaySpeakFor(const rtps::InstanceHandle_t& writer, const std::string& name) const;

  /// Whether messages from here must be sealed.
  bool IsSealed() const { return seal_ != nullptr; }

  /// Now and then: see Neighbours.
  void LogSilent() { neighbours_.LogSilent(); }

  /// Number of participants that were found so far.
  long found() const { return neighbours_.found(); }
  ParticipantPrefix prefix() const;

  dds::DomainParticipant* get() { return participant_; }

 private:
  dds::Topic* FindTopic(const std::string& name);
  dds::Topic* MakeTopic(const std::string& name, dds::TypeSupport type);

  bool has_keys_;
  std::shared_ptr<const Seal> seal_;  ///< null: without secret
  Neighbours neighbours_;
  dds::DomainParticipant* participant_ = nullptr;
};

}  // namespace dispersa
