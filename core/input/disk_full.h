// The errors of the system with which a disk is full for this process, or no more files can be opened.
#pragma once

#include <optional>
#include <string>

namespace dispersa {

/// "no space left on the disk", and which limit was reached if it is not the disk's own; or "too many files
/// are open". Nothing if errno `error` means anything else.
std::optional<std::string> DiskFullWords(int error);

}  // namespace dispersa
