// SQLite's files on full disks and on file systems that lack something. Only database.cc includes it.
#pragma once

namespace dispersa {

/// Name of an SQLite VFS, registered at the first call. It is SQLite's own for this system with three
/// differences:
/// - A file system that cannot sync lacks only the protection from a power cut.
/// - One without locks is an error at once (SQLITE_IOERR_LOCK), and not a lock that another process seems to
///   hold.
/// - Whatever DiskFullWords() knows is SQLITE_FULL.
const char* SqliteFiles();

/// The errno of this thread's last SQLITE_FULL.
int SqliteFullError();

}  // namespace dispersa
