#include "core/input/disk_full.h"

#include <cerrno>

namespace dispersa {

std::optional<std::string> DiskFullWords(int error) {
  const std::string words = "no space left on the disk";
  if (error == ENOSPC) return words;
  if (error == EDQUOT) return words + ": the quota is used up";
  if (error == EFBIG) return words + ": a file has reached its limit (`ulimit -f`, or the file system's)";
  // Files can be made again when others are closed, as on a disk when others are deleted.
  if (error == EMFILE || error == ENFILE)
    return "too many files are open (`ulimit -n`, LimitNOFILE of a unit)";
  return std::nullopt;
}

}  // namespace dispersa
