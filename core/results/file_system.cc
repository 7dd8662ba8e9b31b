#include "core/results/file_system.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/input/disk_full.h"
#include "core/input/input_error.h"
#include "core/results/result_error.h"

namespace dispersa {

void FailFile(const std::string& name, const std::string& what, int error) {
  if (const auto full = DiskFullWords(error))
    throw ResultError(ResultError::Kind::kDiskFull, name + ": " + *full);
  throw ResultError(ResultError::Kind::kFile, fmt::format("{}: {}: {}", name, what, std::strerror(error)));
}

void FailFolder(const std::string& name, const std::error_code& error) {
  if (const auto full = DiskFullWords(error.value()))
    throw ResultError(ResultError::Kind::kDiskFull, name + ": " + *full);
  throw InputError(name + ": cannot be made: " + error.message(), "a folder that can be written");
}

bool IsNotOffered(int error) {
  return error == EINVAL || error == ENOLCK || error == EOPNOTSUPP || error == ENOSYS || error == ENODEV;
}

void RefuseFileSystem(const std::string& name, const std::string& lack, int error) {
  throw ResultError(
      ResultError::Kind::kFileSystem,
      fmt::format("{}: its file system {}: {}, allowed: a folder on a file system with locks and shared "
                  "memory, such as a disk of this machine",
                  name, lack, std::strerror(error)));
}

int OpenRegular(const std::filesystem::path& file, int flags) {
  constexpr char kRule[] = "and no regular file, allowed: a file, or none";
  const int opened = open(file.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0666);
  if (opened < 0) {
    if (errno == ENOENT && (flags & O_CREAT) == 0) return -1;
    if (errno == ELOOP)
      throw ResultError(ResultError::Kind::kFile, fmt::format("{}: is a link {}", file.string(), kRule));
    FailFile(file.string(), (flags & O_CREAT) == 0 ? "cannot be read" : "cannot be written", errno);
  }
  struct stat what {};
  if (fstat(opened, &what) == 0 && S_ISREG(what.st_mode)) return opened;
  close(opened);
  throw ResultError(ResultError::Kind::kFile, fmt::format("{}: is a {} {}", file.string(),
                                                          S_ISFIFO(what.st_mode)  ? "pipe"
                                                          : S_ISDIR(what.st_mode) ? "folder"
                                                                                  : "device",
                                                          kRule));
}

int SyncFile(int file) { return fsync(file) == 0 || IsNotOffered(errno) ? 0 : errno; }

bool LockFile(int file, bool waits, const std::filesystem::path& name) {
  while (flock(file, waits ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) RefuseFileSystem(name.string(), "cannot lock files", errno);
  }
  return true;
}

}  // namespace dispersa
