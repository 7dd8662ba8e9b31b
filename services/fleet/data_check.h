// dispersa fsck, of the data folder of a coordinator that does not run.
#pragma once

#include <filesystem>

#include "services/client/folder_check.h"

namespace dispersa {

/// False: it is no data folder of a coordinator. Throws as CheckFolder().
bool CheckDataFolder(FolderCheck& check, const std::filesystem::path& folder);

}  // namespace dispersa
