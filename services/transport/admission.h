// Rules on who may join the network. Beyond this machine keys are required.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "services/transport/network.h"

namespace dispersa {

/// Options of a command line about keys.
struct Admission {
  std::string keys;       ///< folder (empty: none)
  bool insecure = false;  ///< work without keys: beyond this machine too, and with all users of this machine
  bool allow_plugins = false;
};

inline constexpr char kKeysHelp[] = "folder with the keys of this program, made by `dispersa keys issue`";
inline constexpr char kInsecureHelp[] =
    "work without keys beyond this machine, and with programs of all its users; only for networks that you "
    "trust";

/// A host that is not this machine, if one of them is not; else the first.
std::string FarthestHost(const std::vector<Peer>& peers);

/// `network` as one of `roles` may use it. With keys: encrypted by them. Without keys: over the loopback
/// interface alone, with this user's secret (user_secret.h), if `peer` is there, no address was given, and
/// --insecure is absent. Throws NetworkError with advice if keys, loopback and --insecure are all absent. A
/// coordinator has no peer.
NetworkOptions Admit(NetworkOptions network, const Admission& admission, std::initializer_list<Role> roles,
                     const std::string& peer = "");

inline constexpr char kAllowPluginsHelp[] =
    "accept campaigns whose control law is a shared object: everyone who may launch then runs code here";

/// Without `allowed`, control laws that are shared objects are refused.
void AdmitPlugins(bool allowed);

/// A name on the network: `uuid`, after the name of our keys if we have any.
std::string NameOnNetwork(const NetworkOptions& network, const std::string& uuid);

}  // namespace dispersa
