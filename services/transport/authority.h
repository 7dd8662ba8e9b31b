// Makes the keys with which coordinators, workers, clients and observers know each other.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

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
///
/// The first two functions make a folder as a whole or not at all, readable by the owner alone, and throw
/// InputError rather than overwrite one.
void MakeAuthority(const std::filesystem::path& directory, const Validity& validity);

/// Returns the folder. `right` is that of a client. Keys end with the authority at the latest. More than a
/// day longer is an InputError.
std::filesystem::path IssueKeys(const std::filesystem::path& directory, Role role, const std::string& name,
                                const Validity& validity, Right right = Right::kRun);

/// Adds issued keys to the list of revoked keys, and returns the list's file. The list takes effect where it
/// is copied into the folder of a coordinator's keys. Throws InputError.
std::filesystem::path RevokeKeys(const std::filesystem::path& directory, Role role, const std::string& name);

}  // namespace dispersa
