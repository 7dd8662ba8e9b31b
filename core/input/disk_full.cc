#include "core/input/disk_full.h"

#include <cerrno>

namespace dispersa {

std::optional<std::string> DiskFullWords(int error) {
  const std::string words = "no space left on the disk";
  if (error == ENOSPC) return words;
  if (error == EDQUOT) return words + ": the quota is used up";
  if (error == EFBIG) return words + ": a file has reached its limit (`ulimit -f`, or the file system's)";
  return std::nullopt;
}

}  // namespace dispersa
