#include "services/transport/participant.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <algorithm>
#include <mutex>

#include "services/transport/complaints.h"
#include "services/transport/sieve.h"
#include "services/transport/topics.h"
#include "services/transport/udp_port.h"

namespace dispersa {
namespace {

constexpr std::uint32_t kReceiveBuffer = 4 << 20;
constexpr std::uint32_t kSendBuffer = 1 << 20;

class LogToSpdlog : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    if (entry.kind != dds::Log::Error) return;
    // About a missing permission: the next entry says the same and names the sender.
    if (std::string(entry.context.function ? entry.context.function : "").starts_with("check_remote_"))
      return;
    // Much of it repeats what strangers sent.
    Complain(std::string("Fast DDS, ") + entry.context.category, "the network", entry.message);
  }
};

void ConfigureLibraryOnce() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<LogToSpdlog>());
    TalkBetweenProcessesOnly();
  });
}

rtps::Locator_t MakeLocator(const std::string& address, std::uint16_t port) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  return locator;
}

void AddKeys(const KeyFolder& keys, rtps::PropertyPolicy& properties) {
  const auto add = [&](const std::string& name, const std::string& value) {
    properties.properties().emplace_back("dds.sec." + name, value);
  };
  const auto add_file = [&](const std::string& name, const char* file) {
    add(name, "file://" + (keys.directory / file).string());
  };
  add("auth.plugin", "builtin.PKI-DH");
  add_file("auth.builtin.PKI-DH.identity_ca", kIdentityAuthorityFile);
  add_file("auth.builtin.PKI-DH.identity_certificate", kIdentityFile);
  add_file("auth.builtin.PKI-DH.private_key", kIdentityKeyFile);
  add("access.plugin", "builtin.Access-Permissions");
  add_file("access.builtin.Access-Permissions.permissions_ca", kPermissionsAuthorityFile);
  add_file("access.builtin.Access-Permissions.governance", kGovernanceFile);
  add_file("access.builtin.Access-Permissions.permissions", kPermissionsFile);
  add("crypto.plugin", "builtin.AES-GCM-GMAC");
}

std::string Resolve(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0) {
    throw NetworkError("peer '" + host + "': " + gai_strerror(error));
  }
  char text[INET_ADDRSTRLEN] = "";
  const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  inet_ntop(AF_INET, &address->sin_addr, text, sizeof text);
  freeaddrinfo(found);
  return text;
}

/// Fast DDS itself only says that it filtered all interfaces out, again and again. Empty address: any.
void RequireInterface(const std::string& address) {
  ifaddrs* all = nullptr;
  if (address.empty() || getifaddrs(&all) != 0) return;
  bool exists = false, is_up = false;
  std::string name;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool is_loopback = (each->ifa_flags & IFF_LOOPBACK) != 0;
    char text[INET_ADDRSTRLEN] = "";
    if (each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET)
      inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr, text, sizeof text);
    // An interface that is down may have lost its address.
    if (address != text && !(is_loopback && address.starts_with("127."))) continue;
    exists = true;
    name = each->ifa_name;
    is_up = is_up || (each->ifa_flags & IFF_UP) != 0;
  }
  freeifaddrs(all);
  if (!exists) throw NetworkError("no interface of this machine has the address " + address);
  if (!is_up)
    throw NetworkError("the network interface " + name + " of " + address + " is down: `ip link set " + name +
                       " up` brings it up");
}

/// One that has no address yet, such as a host that is to take over, does not keep us from the others.
void AddPeers(const std::vector<Peer>& peers, rtps::LocatorList_t& list) {
  std::string problem;
  for (const Peer& peer : peers) {
    try {
      list.push_back(MakeLocator(Resolve(peer.host), peer.port));
    } catch (const NetworkError& error) {
      problem = error.what();
    }
  }
  if (list.empty() && !problem.empty()) throw NetworkError(problem);
}

dds::DomainParticipantQos MakeQos(const ParticipantOptions& options) {
  dds::DomainParticipantQos qos;
  qos.name(options.name);

  // No shared memory: after a SIGKILL it leaves segments behind and then fails to match.
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
  const std::string& address = options.network.address;
  if (!address.empty()) udp->interfaceWhiteList.push_back(address);
  // The kernel's default of 212 kB holds 160 results: what 50 workers send while this thread waits for its
  // turn. The kernel gives at most net.core.rmem_max, see services/README.md.
  udp->receiveBufferSize = kReceiveBuffer;
  udp->sendBufferSize = kSendBuffer;
  qos.transport().user_transports.push_back(Sieved(udp, options.network.keys.has_value(), options.door));

  auto& builtin = qos.wire_protocol().builtin;
  // Who is silent is known sooner from its messages. To find a participant again costs a message to and from
  // every other one, so a host that is busy for some seconds does not lose its own.
  builtin.discovery_config.leaseDuration = DdsDuration(20, 0);
  builtin.discovery_config.leaseDuration_announcementperiod = DdsDuration(1, 0);
  // Own locators replace the default ones, which include multicast. Discovery is then by peers alone, and
  // nothing leaves the chosen interface. The ports are explicit. By itself Fast DDS tries a hundred ports and
  // then receives nothing, which limits the number of participants on a host.
  const std::string own = address.empty() ? "0.0.0.0" : address;
  const int domain = options.network.domain;
  const auto free_port = [&](int first) {
    return FreeUdpPort(address, PortOf(domain, first), PortOf(domain, kLastPort));
  };
  const std::uint16_t discovery = options.discovery_port ? *options.discovery_port : free_port(kFirstPort);
  builtin.metatrafficUnicastLocatorList.push_back(MakeLocator(own, discovery));
  qos.wire_protocol().default_unicast_locator_list.push_back(MakeLocator(own, free_port(kFirstPort + 1)));
  AddPeers(options.peers, builtin.initialPeersList);
  if (options.network.keys) AddKeys(*options.network.keys, qos.properties());
  return qos;
}

}  // namespace

Participant::Participant(const ParticipantOptions& options)
    : has_keys_(options.network.keys.has_value()),
      seal_(options.network.secret ? std::make_shared<const Seal>(*options.network.secret) : nullptr),
      neighbours_(has_keys_, options.door.doors) {
  const int domain = options.network.domain;
  if (domain < 0 || domain > 99) {
    throw NetworkError("domain " + std::to_string(domain) + ": must be from 0 to 99");
  }
  if (options.discovery_port && !IsUdpPortFree(options.network.address, *options.discovery_port)) {
    throw NetworkError("UDP port " + std::to_string(*options.discovery_port) +
                       (options.network.address.empty() ? "" : " of " + options.network.address) +
                       " is not free: is there a coordinator in domain " + std::to_string(domain) +
                       " already?");
  }
  RequireInterface(options.network.address);
  ConfigureLibraryOnce();
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<dds::DomainId_t>(domain), MakeQos(options), &neighbours_, dds::StatusMask::none());
  if (participant_ == nullptr) {
    // The likely reason, of keys that were good when the program started.
    if (const auto& keys = options.network.keys) OpenKeyFolder(keys->directory, {keys->role});
    throw NetworkError("no DDS participant in domain " + std::to_string(domain) +
                       (options.network.address.empty() ? "" : " on " + options.network.address));
  }
}

Participant::~Participant() {
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

bool Participant::MaySpeakFor(const rtps::InstanceHandle_t& writer, const std::string& name) const {
  return !has_keys_ || neighbours_.IsIn(rtps::iHandle2GUID(writer), PartitionOf(name));
}

ParticipantPrefix Participant::prefix() const {
  ParticipantPrefix prefix;
  std::copy_n(participant_->guid().guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

dds::Topic* Participant::FindTopic(const std::string& name) {
  return dynamic_cast<dds::Topic*>(participant_->lookup_topicdescription(name));
}

dds::Topic* Participant::MakeTopic(const std::string& name, dds::TypeSupport type) {
  type.register_type(participant_);
  dds::Topic* topic = participant_->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  if (topic == nullptr) throw NetworkError("cannot create the topic " + name);
  return topic;
}

dds::Publisher* Participant::MakePublisher(const std::string& partition) {
  dds::PublisherQos qos;
  if (!partition.empty()) qos.partition().push_back(partition.c_str());
  dds::Publisher* publisher = participant_->create_publisher(qos);
  if (publisher == nullptr) throw NetworkError("cannot create a publisher");
  return publisher;
}

dds::Subscriber* Participant::MakeSubscriber(const std::vector<std::string>& partitions) {
  dds::SubscriberQos qos;
  for (const std::string& partition : partitions) qos.partition().push_back(partition.c_str());
  dds::Subscriber* subscriber = participant_->create_subscriber(qos);
  if (subscriber == nullptr) throw NetworkError("cannot create a subscriber");
  return subscriber;
}

}  // namespace dispersa
