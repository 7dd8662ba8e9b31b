#include "services/transport/admission.h"

#include <arpa/inet.h>

#include <algorithm>

#include "core/containment/contained.h"
#include "services/log/log.h"
#include "services/transport/user_secret.h"

namespace dispersa {
namespace {

constexpr char kLoopback[] = "127.0.0.1";

bool IsLoopback(const std::string& host) {
  in_addr address{};
  return host == "localhost" ||
         (host.rfind("127.", 0) == 0 && inet_pton(AF_INET, host.c_str(), &address) == 1);
}

}  // namespace

std::string FarthestHost(const std::vector<Peer>& peers) {
  const auto far =
      std::find_if(peers.begin(), peers.end(), [](const Peer& peer) { return !IsLoopback(peer.host); });
  return (far == peers.end() ? peers.front() : *far).host;
}

NetworkOptions Admit(NetworkOptions network, const Admission& admission, std::initializer_list<Role> roles,
                     const std::string& peer) {
  if (!admission.keys.empty()) {
    if (admission.insecure) throw NetworkError("--keys and --insecure exclude each other");
    network.keys = OpenKeyFolder(admission.keys, roles);
    return network;
  }
  // A coordinator that is not on this machine's interface alone announces itself with its other addresses:
  // whoever may use those keeps all interfaces, also with a peer on this machine.
  if (network.address.empty() && IsLoopback(peer) && !admission.insecure) network.address = kLoopback;
  if (IsLoopback(network.address) && (peer.empty() || IsLoopback(peer))) {
    // Every user of this machine can join the domain.
    if (!admission.insecure) network.secret = OpenUserSecret(UserSecretFile());
    return network;
  }
  if (!admission.insecure) {
    throw NetworkError(
        "a network beyond this machine needs keys, allowed: --keys DIR with a folder that `dispersa keys "
        "issue` made, --address 127.0.0.1 for this machine alone, or --insecure on a network that you trust");
  }
  LogWarning("no keys (--insecure): everyone on this network can read, join and forge");
  return network;
}

void AdmitPlugins(bool allowed) {
  if (allowed) return;
  RefusePlugins("is a shared object; this program runs shared objects only with --allow-plugins");
}

std::string NameOnNetwork(const NetworkOptions& network, const std::string& uuid) {
  if (!network.keys) return uuid;
  const KeyFolder& keys = *network.keys;
  return (keys.right ? ClientPrefix(keys.name, *keys.right) : OwnPrefix(keys.name)) + uuid;
}

}  // namespace dispersa
