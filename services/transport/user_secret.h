// The secret that all programs of one user on a machine share, without keys: other users are not listened to.
#pragma once

#include <filesystem>

#include "services/transport/seal.h"

namespace dispersa {

/// HOME/.dispersa/secret, or in the home folder that the system knows. Throws NetworkError where there is
/// none.
std::filesystem::path UserSecretFile();

/// The secret in the file. If there is none it is drawn and written, once, even if several processes start
/// together. NetworkError refuses a file of another user, one that others may read or write, and one without
/// a secret.
Secret OpenUserSecret(const std::filesystem::path& file);

}  // namespace dispersa
