#include "services/transport/endpoints.h"
#include "services/log/log.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace dispersa {
namespace {

template <typename Qos>
void SetCommonQos(Qos& qos, int depth) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  // No late reader depends on earlier messages: important ones are repeated (services/README.md).
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.resource_limits().max_samples = 0;  // no limit but the depth
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.data_sharing().off();
  // The generated types guess the size of unbounded members; allocate what a sample really needs.
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
}

}  // namespace

dds::DataWriterQos MakeWriterQos(int depth) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  SetCommonQos(qos, depth);
  // Lost messages are sent again after this time, and not after 3 s.
  SetHeartbeat(qos, DdsDuration(0, 200000000));
  qos.reliability().max_blocking_time = DdsDuration(0, 100000000);
  return qos;
}

dds::DataReaderQos MakeReaderQos(const std::string& address, std::uint16_t port) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  SetCommonQos(qos, kDepth);
  if (port != 0) {
    rtps::Locator_t own;
    own.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(own, address.empty() ? "0.0.0.0" : address);
    own.port = port;
    qos.endpoint().unicast_locator_list.push_back(own);
  }
  return qos;
}

void LogIncompatibleQos(const std::string& topic, dds::QosPolicyId_t policy) {
  LogError("{}: a peer's quality of service does not match (policy {}): another version of dispersa?", topic,
           static_cast<int>(policy));
}

Seal::Writer NameOfWriter(const rtps::GUID_t& writer) {
  Seal::Writer name;
  const auto* prefix = writer.guidPrefix.value;
  const auto* entity = writer.entityId.value;
  std::copy_n(entity, 4, std::copy_n(prefix, 12, name.begin()));
  return name;
}

bool PutSeal(const Seal& seal, const std::string& topic, const Seal::Origin& origin,
             rtps::SerializedPayload_t& payload) {
  const std::uint32_t filled = (payload.length + 3) / 4 * 4;
  if (filled + Seal::kSize > payload.max_size) return false;
  std::fill(payload.data + payload.length, payload.data + filled, std::uint8_t{0});
  seal.Put(topic, origin, payload.data, filled);
  payload.length = filled + static_cast<std::uint32_t>(Seal::kSize);
  return true;
}

bool HeardSeals::IsNew(const rtps::InstanceHandle_t& writer, const Seal::Origin& origin) {
  if (origin.writer != NameOfWriter(rtps::iHandle2GUID(writer))) return false;
  std::uint64_t& last = last_[origin.writer];
  if (origin.number <= last) return false;
  last = origin.number;
  return true;
}

std::string ParticipantOf(const rtps::InstanceHandle_t& endpoint) {
  constexpr int kPrefix = 12;  // bytes of a GUID that name the participant
  std::array<char, 2 * kPrefix + 1> text{};
  for (int i = 0; i < kPrefix; ++i) {
    std::snprintf(text.data() + 2 * i, 3, "%02x", static_cast<unsigned>(endpoint.value[i]));
  }
  return text.data();
}

}  // namespace dispersa
