#include "core/results/sqlite_files.h"

#include <sqlite3.h>

#include <cerrno>
#include <list>
#include <mutex>

#include "core/input/disk_full.h"
#include "core/results/file_system.h"

namespace dispersa {
namespace {

thread_local int full_error = ENOSPC;

/// SQLite's own.
sqlite3_vfs* System() { return sqlite3_vfs_find(nullptr); }

/// The methods of an open file: SQLite's but for some.
struct Methods {
  sqlite3_io_methods own;  ///< first: a file points to it
  const sqlite3_io_methods* of_system;
};

const sqlite3_io_methods& OfSystem(const sqlite3_file* file) {
  return *reinterpret_cast<const Methods*>(file->pMethods)->of_system;
}

int OrUnsynced(int code) {
  const bool is_sync = code == SQLITE_IOERR_FSYNC || code == SQLITE_IOERR_DIR_FSYNC;
  return is_sync && IsNotOffered(errno) ? SQLITE_OK : code;
}

int Lock(sqlite3_file* file, int level) {
  errno = 0;
  const int code = OfSystem(file).xLock(file, level);
  return code == SQLITE_BUSY && errno == ENOLCK ? SQLITE_IOERR_LOCK : code;
}

/// SQLite itself knows ENOSPC alone, and not when it makes the index of a log larger.
int OrFull(int code) {
  if ((code & 0xff) != SQLITE_IOERR || !DiskFullWords(errno)) return code;
  full_error = errno;
  return SQLITE_FULL;
}

int Sync(sqlite3_file* file, int flags) {
  full_error = ENOSPC;
  return OrFull(OrUnsynced(OfSystem(file).xSync(file, flags)));
}

int Write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 offset) {
  full_error = ENOSPC;
  return OrFull(OfSystem(file).xWrite(file, bytes, size, offset));
}

int MapShared(sqlite3_file* file, int region, int size, int extends, void volatile** memory) {
  full_error = ENOSPC;
  return OrFull(OfSystem(file).xShmMap(file, region, size, extends, memory));
}

/// SQLite has methods for databases and others for their logs and journals.
const Methods& MethodsFor(const sqlite3_io_methods* of_system) {
  static std::mutex mutex;
  static std::list<Methods> known;
  const std::lock_guard lock(mutex);
  for (const Methods& methods : known)
    if (methods.of_system == of_system) return methods;
  Methods& methods = known.emplace_back(Methods{*of_system, of_system});
  methods.own.xSync = Sync;
  methods.own.xLock = Lock;
  methods.own.xWrite = Write;
  if (of_system->iVersion >= 2) methods.own.xShmMap = MapShared;
  return methods;
}

int Open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* flags_out) {
  const int code = System()->xOpen(System(), name, file, flags, flags_out);
  if (file->pMethods != nullptr) file->pMethods = &MethodsFor(file->pMethods).own;
  return code;
}

int Delete(sqlite3_vfs*, const char* name, int sync_folder) {
  return OrUnsynced(System()->xDelete(System(), name, sync_folder));
}

}  // namespace

int SqliteFullError() { return full_error; }

const char* SqliteFiles() {
  static sqlite3_vfs files = [] {
    sqlite3_initialize();
    sqlite3_vfs own = *System();
    own.zName = "dispersa";
    own.pNext = nullptr;
    own.xOpen = Open;
    own.xDelete = Delete;
    return own;
  }();
  static const bool registered = sqlite3_vfs_register(&files, 0) == SQLITE_OK;
  return registered ? files.zName : nullptr;
}

}  // namespace dispersa
