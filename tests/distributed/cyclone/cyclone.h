// Code shared by the two programs of this folder: how a program with DDS of another vendor joins
// (idl/README.md).
#pragma once

#include <dds/dds.h>

#include <array>
#include <cstdlib>
#include <iostream>
#include <string>

namespace cyclone {

/// Ends the program if a call failed.
inline dds_entity_t Check(dds_return_t returned, const std::string& what) {
  if (returned >= 0) return returned;
  std::cerr << what << ": " << dds_strretcode(-returned) << "\n";
  std::exit(1);
}

/// A participant that knows the coordinator and nobody else. Discovery is unicast: no multicast, and one
/// interface; the announcements of a second's period find a coordinator that starts later or again.
inline dds_entity_t Join(int domain) {
  const int port = 7400 + 250 * domain + 5;
  const std::string config =
      "<CycloneDDS><Domain>"
      "<General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General>"
      "<Discovery><ParticipantIndex>none</ParticipantIndex><SPDPInterval>1s</SPDPInterval>"
      "<Peers><Peer address='127.0.0.1:" +
      std::to_string(port) + "'/></Peers></Discovery></Domain></CycloneDDS>";
  const auto id = static_cast<dds_domainid_t>(domain);
  Check(dds_create_domain(id, config.c_str()), "domain");
  return Check(dds_create_participant(id, nullptr, nullptr), "participant");
}

/// "dispersa::idl::ResultV2" travels as "dispersa/ResultV2".
inline dds_entity_t Topic(dds_entity_t participant, const dds_topic_descriptor_t& type) {
  const std::string name = type.m_typename;
  return Check(dds_create_topic(participant, &type, ("dispersa/" + name.substr(name.rfind(':') + 1)).c_str(),
                                nullptr, nullptr),
               name);
}

/// All topics': reliable, volatile. A reader may keep all that it has not taken yet.
inline dds_qos_t* Qos(dds_history_kind_t history) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, history, 512);
  return qos;
}

/// `partition`: of what is meant for one worker or client; else empty.
inline dds_entity_t Reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                           const std::string& partition = "") {
  dds_qos_t* group = dds_create_qos();
  if (!partition.empty()) dds_qset_partition1(group, partition.c_str());
  const dds_entity_t subscriber = Check(dds_create_subscriber(participant, group, nullptr), "subscriber");
  dds_qos_t* qos = Qos(DDS_HISTORY_KEEP_ALL);
  const dds_entity_t reader =
      Check(dds_create_reader(subscriber, Topic(participant, type), qos, nullptr), "reader");
  dds_delete_qos(qos);
  dds_delete_qos(group);
  return reader;
}

inline dds_entity_t Writer(dds_entity_t participant, const dds_topic_descriptor_t& type) {
  dds_qos_t* qos = Qos(DDS_HISTORY_KEEP_LAST);
  const dds_entity_t writer =
      Check(dds_create_writer(participant, Topic(participant, type), qos, nullptr), "writer");
  dds_delete_qos(qos);
  return writer;
}

/// Calls `on` with each sample that has come.
template <typename Message, typename On>
void TakeAll(dds_entity_t reader, On on) {
  constexpr std::size_t kAtOnce = 64;
  for (int taken = 1; taken > 0;) {
    std::array<void*, kAtOnce> samples{};  // lent by the reader
    std::array<dds_sample_info_t, kAtOnce> infos;
    taken = Check(dds_take(reader, samples.data(), infos.data(), kAtOnce, kAtOnce), "take");
    for (int i = 0; i < taken; ++i) {
      if (infos[i].valid_data) on(*static_cast<const Message*>(samples[i]));
    }
    Check(dds_return_loan(reader, samples.data(), taken), "loan");
  }
}

}  // namespace cyclone
