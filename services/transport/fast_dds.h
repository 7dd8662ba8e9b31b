// Fast DDS 2 (Debian 12) and Fast DDS 3 (Debian 13) under one set of names: those of `dds`, `rtps` and below.
// No other file tells the releases apart. Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/publisher/qos/PublisherQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/subscriber/qos/SubscriberQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#if __has_include(<fastdds/config.hpp>)
#define DISPERSA_FAST_DDS 3
#include <fastdds/LibrarySettings.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#else
#define DISPERSA_FAST_DDS 2
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#endif

namespace dispersa {

namespace dds = eprosima::fastdds::dds;

#if DISPERSA_FAST_DDS == 3
namespace rtps = eprosima::fastdds::rtps;
using DdsDuration = dds::Duration_t;
inline constexpr dds::ReturnCode_t kDdsOk = dds::RETCODE_OK;
#else
namespace rtps {
using namespace eprosima::fastdds::rtps;
using namespace eprosima::fastrtps::rtps;
// Names of both, which clang takes for hidden ones.
using eprosima::fastdds::rtps::LocatorsIterator;
using eprosima::fastdds::rtps::TransportDescriptorInterface;
using eprosima::fastdds::rtps::TransportInterface;
}  // namespace rtps
using DdsDuration = eprosima::fastrtps::Duration_t;
inline constexpr auto kDdsOk = eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
#endif

/// Where both have keys, this release finds a participant before the two shake hands; the other one after it.
inline constexpr bool kIsFoundFirst = DISPERSA_FAST_DDS == 2;

/// Participants of one process (tests) talk as those of two do.
inline void TalkBetweenProcessesOnly() {
#if DISPERSA_FAST_DDS == 3
  eprosima::fastdds::LibrarySettings settings;
  settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
  dds::DomainParticipantFactory::get_instance()->set_library_settings(settings);
#else
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
#endif
}

/// How long a writer waits until it asks its readers again what they lack.
inline void SetHeartbeat(dds::DataWriterQos& qos, const DdsDuration& period) {
#if DISPERSA_FAST_DDS == 3
  qos.reliable_writer_qos().times.heartbeat_period = period;
#else
  qos.reliable_writer_qos().times.heartbeatPeriod = period;
#endif
}

/// A generated type whose bytes pass through our hands: plain CDR of the first version in both releases.
template <typename PubSubType>
class CodedType : public PubSubType {
 public:
  using Payload = rtps::SerializedPayload_t;

  virtual bool Encode(const void* data, Payload& payload) { return EncodePlain(data, payload); }
  virtual bool Decode(Payload& payload, void* data) { return DecodePlain(payload, data); }
  /// The most that Encode() needs.
  virtual std::uint32_t SizeOf(const void* data) { return PlainSizeOf(data); }

 protected:
#if DISPERSA_FAST_DDS == 3
  bool EncodePlain(const void* data, Payload& payload) {
    return PubSubType::serialize(data, payload, dds::XCDR_DATA_REPRESENTATION);
  }
  bool DecodePlain(Payload& payload, void* data) { return PubSubType::deserialize(payload, data); }
  std::uint32_t PlainSizeOf(const void* data) {
    return PubSubType::calculate_serialized_size(data, dds::XCDR_DATA_REPRESENTATION);
  }

 private:
  bool serialize(const void* const data, Payload& payload, dds::DataRepresentationId_t) final {
    return Encode(data, payload);
  }
  bool deserialize(Payload& payload, void* data) final { return Decode(payload, data); }
  std::uint32_t calculate_serialized_size(const void* const data, dds::DataRepresentationId_t) final {
    return SizeOf(data);
  }
#else
  // The library takes what it only reads as if it would write it.
  bool EncodePlain(const void* data, Payload& payload) {
    return PubSubType::serialize(const_cast<void*>(data), &payload);
  }
  bool DecodePlain(Payload& payload, void* data) { return PubSubType::deserialize(&payload, data); }
  std::uint32_t PlainSizeOf(const void* data) {
    return PubSubType::getSerializedSizeProvider(const_cast<void*>(data))();
  }

 private:
  bool serialize(void* data, Payload* payload) final { return Encode(data, *payload); }
  bool deserialize(Payload* payload, void* data) final { return Decode(*payload, data); }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) final {
    return [this, data] { return SizeOf(data); };
  }
#endif
};

/// What the middleware finds on the network.
class Discovery : public dds::DomainParticipantListener {
 private:
  /// A participant, found with the addresses of its discovery, or gone.
  virtual void OnFound(const rtps::GUID_t& participant, const rtps::RemoteLocatorList& addresses) = 0;
  virtual void OnGone(const rtps::GUID_t& participant) = 0;
  virtual void OnAuthenticated(const rtps::GUID_t& participant, bool is_authorized) = 0;
  /// A writer was found or has other partitions, or is gone. A reader was found.
  virtual void OnWriter(const rtps::GUID_t& writer, const std::vector<std::string>& partitions) = 0;
  virtual void OnWriterGone(const rtps::GUID_t& writer) = 0;
  virtual void OnReader(const rtps::GUID_t& reader) = 0;

  using Authentication = rtps::ParticipantAuthenticationInfo;
  void onParticipantAuthentication(dds::DomainParticipant*, Authentication&& who) final {
    OnAuthenticated(who.guid, who.status == Authentication::AUTHORIZED_PARTICIPANT);
  }
#if DISPERSA_FAST_DDS == 3
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus status,
                                const dds::ParticipantBuiltinTopicData& who, bool&) final {
    if (status == rtps::ParticipantDiscoveryStatus::CHANGED_QOS_PARTICIPANT) return;
    if (status == rtps::ParticipantDiscoveryStatus::DISCOVERED_PARTICIPANT) {
      OnFound(who.guid, who.metatraffic_locators);
    } else {
      OnGone(who.guid);
    }
  }
  void on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus status,
                                const dds::PublicationBuiltinTopicData& what, bool&) final {
    if (status == rtps::WriterDiscoveryStatus::REMOVED_WRITER) {
      OnWriterGone(what.guid);
    } else {
      OnWriter(what.guid, what.partition.getNames());
    }
  }
  void on_data_reader_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryStatus status,
                                const dds::SubscriptionBuiltinTopicData& what, bool&) final {
    if (status == rtps::ReaderDiscoveryStatus::DISCOVERED_READER) OnReader(what.guid);
  }
#else
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& found) final {
    if (found.status == found.CHANGED_QOS_PARTICIPANT) return;
    if (found.status == found.DISCOVERED_PARTICIPANT) {
      OnFound(found.info.m_guid, found.info.metatraffic_locators);
    } else {
      OnGone(found.info.m_guid);
    }
  }
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) final {
    if (found.status == found.REMOVED_WRITER) {
      OnWriterGone(found.info.guid());
    } else {
      OnWriter(found.info.guid(), found.info.m_qos.m_partition.getNames());
    }
  }
  void on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& found) final {
    if (found.status == found.DISCOVERED_READER) OnReader(found.info.guid());
  }
#endif
};

/// A transport in front of another one that looks at what comes in. What goes out passes.
class ReceivingTransport : public rtps::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

 private:
#if DISPERSA_FAST_DDS == 3
  bool send(rtps::SenderResource* inner, const std::vector<rtps::NetworkBuffer>& buffers, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) final {
    return inner->send(buffers, size, begin, end, timeout);
  }
#else
  bool send(rtps::SenderResource* inner, const rtps::octet* data, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) final {
    return inner->send(data, size, begin, end, timeout);
  }
#endif
};

}  // namespace dispersa
