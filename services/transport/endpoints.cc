#include "services/transport/endpoints.h"

#include <spdlog/spdlog.h>

namespace dispersa {
namespace {

namespace dds = eprosima::fastdds::dds;

template <typename Qos>
void SetCommonQos(Qos& qos, Presence presence) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  // Volatile readers can lose the first samples after matching.
  qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  if (presence == Presence::kHeartbeat) {
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 1;
    qos.liveliness().kind = dds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
    qos.liveliness().lease_duration = eprosima::fastrtps::Duration_t(kHeartbeatLeaseSeconds, 0);
  } else {
    qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
    qos.resource_limits().max_samples = 0;  // no limit
    qos.resource_limits().max_instances = 0;
    qos.resource_limits().max_samples_per_instance = 0;
  }
  qos.data_sharing().off();
  // The generated types guess the size of unbounded members; allocate what a sample really needs.
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
}

}  // namespace

dds::DataWriterQos MakeWriterQos(Presence presence) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  SetCommonQos(qos, presence);
  // What was lost is sent again after this long and not after 3 s.
  qos.reliable_writer_qos().times.heartbeatPeriod = eprosima::fastrtps::Duration_t(0, 200000000);
  qos.reliability().max_blocking_time = eprosima::fastrtps::Duration_t(1, 0);
  return qos;
}

dds::DataReaderQos MakeReaderQos(Presence presence) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  SetCommonQos(qos, presence);
  return qos;
}

void LogIncompatibleQos(const std::string& topic, dds::QosPolicyId_t policy) {
  spdlog::error("{}: a peer's quality of service does not match (policy {}): another version of dispersa?",
                topic, static_cast<int>(policy));
}

}  // namespace dispersa
