// What results need of a file system, and the errors of those that lack it.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace dispersa {

/// Throws ResultError for errno `error`: kDiskFull if the disk is full, else kFile with `what` and the
/// system's reason.
[[noreturn]] void FailFile(const std::string& name, const std::string& what, int error);
/// For a folder that cannot be made: ResultError (kDiskFull) if the disk is full, else InputError.
[[noreturn]] void FailFolder(const std::string& name, const std::error_code& error);

/// True if errno `error` says that the file system does not have the operation.
bool IsNotOffered(int error);
/// Throws ResultError (kFileSystem). `lack`: "cannot lock files".
[[noreturn]] void RefuseFileSystem(const std::string& name, const std::string& lack, int error);

/// Opens a file, never a link, a pipe or a device, and waits for nobody. -1: there is none, and `flags` make
/// none. Throws ResultError.
int OpenRegular(const std::filesystem::path& file, int flags);

/// fsync. A file system without it lacks only the protection from a power cut. Otherwise returns the errno.
int SyncFile(int file);
/// flock. False if another process holds the lock and `waits` is false. Throws ResultError (kFileSystem).
bool LockFile(int file, bool waits, const std::filesystem::path& name);

}  // namespace dispersa
