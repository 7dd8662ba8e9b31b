// The secret that all programs of one user on a machine share, without keys: other users are not listened to.
#pragma once

#include <filesystem>

#include "services/transport/seal.h"

namespace dispersa {

/// HOME/.dispersa/secret, or in the home folder that the system knows. Throws NetworkError where there is
/// none.
std::filesystem::path UserSecretFile();

/// What the file holds; it is drawn and written if there is none, by one of several that start at once.
/// Refused with a NetworkError: a file of another user, one that others may read or write, one that is no
/// secret.
Secret OpenUserSecret(const std::filesystem::path& file);

}  // namespace dispersa
