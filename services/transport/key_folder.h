// The folder with which a process shows who it is: what `dispersa keys issue` made, and nothing secret of
// others.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>

#include "services/transport/permissions.h"

namespace dispersa {

struct KeyFolder {
  std::filesystem::path directory;
  Role role = Role::kObserver;
  std::string name;
  std::optional<Right> right = {};  ///< of a client; none in keys of an earlier version
};

// The files of a folder. Those of the authorities may have several certificates: each is believed.
inline constexpr char kIdentityAuthorityFile[] = "identity_ca.pem";
inline constexpr char kPermissionsAuthorityFile[] = "permissions_ca.pem";
inline constexpr char kGovernanceFile[] = "governance.p7s";
inline constexpr char kIdentityFile[] = "identity.pem";
inline constexpr char kIdentityKeyFile[] = "identity.key";
inline constexpr char kPermissionsFile[] = "permissions.p7s";
/// Optional: revocations.h.
inline constexpr char kRevokedFile[] = "revoked.p7s";

/// Reads the folder and checks all of it: each file, signatures, dates, that no other user of the machine can
/// use the key, and that the folder is for one of `roles`. Throws NetworkError with the fault and the remedy.
KeyFolder OpenKeyFolder(const std::filesystem::path& directory, std::initializer_list<Role> roles);

/// The text of a file. `maker`: the command that makes it. Throws NetworkError.
std::string ReadKeyFile(const std::filesystem::path& file, const char* maker = "dispersa keys issue");

}  // namespace dispersa
