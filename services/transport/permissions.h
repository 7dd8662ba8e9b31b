// Rights to publish and subscribe: the documents of DDS Security that the authority signs.
#pragma once

#include <array>
#include <ctime>
#include <optional>
#include <string>

namespace dispersa {

enum class Role { kCoordinator, kWorker, kClient, kObserver };

inline constexpr std::array<Role, 4> kRoles = {Role::kCoordinator, Role::kWorker, Role::kClient,
                                               Role::kObserver};

const char* Name(Role role);
std::optional<Role> ParseRole(const std::string& text);

/// What a client may ask of a coordinator. Each right includes those before it.
enum class Right {
  kRead,       ///< list, status, watch, fetch
  kRun,        ///< launch, and change campaigns of its own
  kAdminister  ///< change all campaigns, back up
};

inline constexpr std::array<Right, 3> kRights = {Right::kRead, Right::kRun, Right::kAdminister};

/// "read", "run", "administer".
const char* Name(Right right);
std::optional<Right> ParseRight(const std::string& text);

/// Workers and clients with keys are called NAME_… after their keys. No other participant may write or read
/// under such a name. Names of keys have no '_'.
std::string OwnPrefix(const std::string& name);
/// Clients are called _RIGHT_NAME_… after their keys. Permissions for that name are signed, so nobody claims
/// a right that its keys have not. Clients with keys of an earlier version have no right in their name.
std::string ClientPrefix(const std::string& name, Right right);
/// The right in a client's name. Keys of an earlier version may run.
Right RightOf(const std::string& client);
/// The name of the keys of a participant named `who`; empty if it has none.
std::string KeyNameOf(const std::string& who);
/// The name under which a participant is counted and expelled: that of its keys, or its own if it has none.
std::string AccountOf(const std::string& who);

/// The protection of all traffic, the same for all participants.
std::string GovernanceDocument();

/// One participant's rights to publish and subscribe. `subject` is SubjectText of its certificate. `right`
/// is that of a client.
std::string PermissionsDocument(Role role, const std::string& name, Right right, const std::string& subject,
                                std::time_t not_before, std::time_t not_after);

}  // namespace dispersa
