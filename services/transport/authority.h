// Makes the keys with which coordinators, workers, clients and observers know each other.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "services/transport/permissions.h"

namespace dispersa {

/// When keys are valid.
struct Validity {
  std::time_t not_before;
  std::time_t not_after;
};

/// From a day ago, because clocks differ, for `days` from now on.
Validity ValidFor(int days);

/// An authority is a folder:
///
///   authority/identity_ca.{key,pem}      signs the identity of each participant
///   authority/permissions_ca.{key,pem}   signs permissions. It is separate: otherwise a participant with a
///                                        certificate could sign permissions for itself
///   authority/governance.p7s             the protection of all topics
///   issued/<role>-<name>/                one folder for each participant, with all that it needs
///   revoked.p7s                          revoked keys (revocations.h), once there are any
///   serials.txt                          a line "ROLE NAME SERIAL UNTIL" for all keys that were issued
///
/// After RenewAuthority() the files of certificates have those of before, too: whoever has these files
/// believes keys of both.
///
/// MakeAuthority and IssueKeys make a folder as a whole or not at all, readable by the owner alone, and throw
/// InputError rather than overwrite one.
void MakeAuthority(const std::filesystem::path& directory, const Validity& validity);

/// From now on another authority issues keys. The keys of before are believed too, until RetireAuthority().
/// Return the folder with the former authority, which nobody needs when all is well.
std::filesystem::path RenewAuthority(const std::filesystem::path& directory, const Validity& validity);
std::filesystem::path RetireAuthority(const std::filesystem::path& directory);

/// Returns the folder. Revoked keys of the same name give way. `right` is that of a client. Keys end with the
/// authority at the latest. More than a day longer is an InputError.
std::filesystem::path IssueKeys(const std::filesystem::path& directory, Role role, const std::string& name,
                                const Validity& validity, Right right = Right::kRun);

struct IssuedKeys {
  Role role;
  std::string name;
  std::string serial;
  std::string until;  ///< "2027-01-31"; empty: not known
  bool is_revoked;
};
/// All that this and former authorities of the folder issued, the first first.
std::vector<IssuedKeys> ListKeys(const std::filesystem::path& directory);

/// Adds issued keys to the list of revoked keys, and returns the list's file: those with this serial, or all
/// of this name. The list takes effect where it is copied into the folder of a coordinator's keys. Throws
/// InputError.
std::filesystem::path RevokeKeys(const std::filesystem::path& directory, Role role, const std::string& name,
                                 const std::string& serial = "");

}  // namespace dispersa
