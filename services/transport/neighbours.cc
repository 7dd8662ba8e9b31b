#include "services/transport/neighbours.h"

#include <algorithm>

#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>

#include "services/transport/complaints.h"
#include "services/transport/endpoints.h"

namespace dispersa {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::chrono::seconds kHandshakePatience(5);
constexpr std::size_t kMostHandshakes = 1024;  // strangers may make up participants without end
constexpr char kBadKeys[] =
    "its keys are of another authority, expired or damaged, or the first contact with it was interrupted";

std::string WhoIs(const rtps::ParticipantProxyData& participant) {
  const auto& addresses = participant.metatraffic_locators.unicast;
  return ParticipantOf(participant.m_guid) +
         (addresses.empty() ? "" : " at " + rtps::IPLocator::ip_to_string(addresses.front()));
}

ParticipantPrefix PrefixOf(const rtps::GUID_t& guid) {
  ParticipantPrefix prefix;
  std::copy_n(guid.guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

}  // namespace

// Its readers and writers come last, after the handshake.
void Neighbours::TellJoined(const rtps::GUID_t& endpoint) const {
  if (doors_) doors_->Joined(PrefixOf(endpoint));
}

bool Neighbours::IsIn(const rtps::GUID_t& writer, const std::string& partition) const {
  const Lock lock(mutex_);
  const auto known = partitions_.find(writer);
  return known != partitions_.end() && known->second == std::vector<std::string>{partition};
}

void Neighbours::on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& found) {
  using Found = rtps::ParticipantDiscoveryInfo;
  if (found.status == Found::CHANGED_QOS_PARTICIPANT) return;
  const Lock lock(mutex_);
  if (found.status != Found::DISCOVERED_PARTICIPANT) {
    handshakes_.erase(found.info.m_guid);
    if (doors_) doors_->Gone(PrefixOf(found.info.m_guid));
    return;
  }
  ++found_;
  if (doors_) doors_->Found(PrefixOf(found.info.m_guid));
  const bool it_has_keys = !found.info.identity_token_.class_id().empty();
  if (we_have_keys_ && it_has_keys) {
    if (handshakes_.size() < kMostHandshakes) {
      handshakes_[found.info.m_guid] = {std::chrono::steady_clock::now() + kHandshakePatience,
                                        WhoIs(found.info)};
    }
  } else if (we_have_keys_ != it_has_keys) {
    TellJoined(found.info.m_guid);  // it never will
    Complain("participant", WhoIs(found.info),
             we_have_keys_ ? "it has no keys" : "it has keys, and we have none to show (--keys)");
  }
}

void Neighbours::onParticipantAuthentication(dds::DomainParticipant*,
                                             rtps::ParticipantAuthenticationInfo&& who) {
  const Lock lock(mutex_);
  handshakes_.erase(who.guid);
  if (who.status == rtps::ParticipantAuthenticationInfo::UNAUTHORIZED_PARTICIPANT) {
    TellJoined(who.guid);  // it never will
    Complain("participant", ParticipantOf(who.guid), kBadKeys);
  }
}

void Neighbours::LogSilent() {
  const Lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(handshakes_, [&](const auto& each) {
    const bool is_silent = now > each.second.due;
    if (is_silent) Complain("participant", each.second.who, kBadKeys);
    return is_silent;
  });
}

// A participant that changes partitions could use its permission for one partition in another. It is not
// heard any more.
void Neighbours::on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) {
  const Lock lock(mutex_);
  if (found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) {
    partitions_.erase(found.info.guid());
    return;
  }
  TellJoined(found.info.guid());
  std::vector<std::string> now = found.info.m_qos.m_partition.getNames();
  const auto [known, is_new] = partitions_.try_emplace(found.info.guid(), now);
  if (!is_new && known->second != now) known->second.clear();
}

void Neighbours::on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& found) {
  if (found.status == rtps::ReaderDiscoveryInfo::DISCOVERED_READER) TellJoined(found.info.guid());
}

}  // namespace dispersa
