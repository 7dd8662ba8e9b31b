// Who may speak where: keys are wanted beyond this machine.
#pragma once

#include <initializer_list>
#include <string>

#include "services/transport/network.h"

namespace dispersa {

/// What a command line says of it.
struct Admission {
  std::string keys;       ///< folder; empty: none
  bool insecure = false;  ///< none: beyond this machine all the same, on it with all users
  bool allow_plugins = false;
};

inline constexpr char kKeysHelp[] = "folder that `dispersa keys issue` made: who we are";
inline constexpr char kInsecureHelp[] =
    "without keys beyond this machine, and on it with programs of all users: on networks that you trust";

/// `network` as it may be used by one of `roles`: with the keys; without, with the loopback interface alone
/// if that is where `peer` is, no address was given, and nobody said --insecure; there with the secret of
/// this user (user_secret.h). Throws NetworkError with what to do when neither keys nor the loopback
/// interface nor --insecure is there. A coordinator has no peer.
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
