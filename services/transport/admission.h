// Rules on who may join the network. Beyond this machine keys are required.
#pragma once

#include <initializer_list>
#include <string>

#include "services/transport/network.h"

namespace dispersa {

/// Options of a command line about keys.
struct Admission {
  std::string keys;       ///< folder (empty: none)
  bool insecure = false;  ///< none: beyond this machine all the same, on it with all users
  bool allow_plugins = false;
};

inline constexpr char kKeysHelp[] = "folder that `dispersa keys issue` made: who we are";
inline constexpr char kInsecureHelp[] =
    "without keys beyond this machine, and on it with programs of all users: on networks that you trust";

/// `network` as one of `roles` may use it. With keys: encrypted by them. Without keys: over the loopback
/// interface alone, with this user's secret (user_secret.h), if `peer` is there, no address was given, and
/// --insecure is absent. Throws NetworkError with advice if keys, loopback and --insecure are all absent. A
/// coordinator has no peer.
NetworkOptions Admit(NetworkOptions network, const Admission& admission, std::initializer_list<Role> roles,
                     const std::string& peer = "");

inline constexpr char kAllowPluginsHelp[] =
    "take campaigns whose control law is a shared object: whoever may launch runs code here; without it they "
    "are "
    "refused";

/// Without `allowed`, control laws that are shared objects are refused.
void AdmitPlugins(bool allowed);

/// A name on the network: `uuid`, after the name of our keys if we have any.
std::string NameOnNetwork(const NetworkOptions& network, const std::string& uuid);

}  // namespace dispersa
