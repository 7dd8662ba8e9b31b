#include "core/results/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>

#include "core/input/disk_full.h"
#include "core/input/input_error.h"
#include "core/results/file_system.h"
#include "core/results/result_error.h"
#include "core/results/sqlite_files.h"

namespace dispersa {
namespace {

/// What the file system lacks; null: nothing.
const char* LackOf(int code, int system_error) {
  switch (code) {
    case SQLITE_IOERR_LOCK:
    case SQLITE_IOERR_RDLOCK:
    case SQLITE_IOERR_UNLOCK:
    case SQLITE_IOERR_CHECKRESERVEDLOCK:
      return IsNotOffered(system_error) ? "cannot lock files" : nullptr;
    case SQLITE_IOERR_SHMMAP:
      return system_error != ENOMEM ? "cannot share memory between processes" : nullptr;
    default:
      return nullptr;
  }
}

/// SQLite adds up to eight characters to a path. Its own limit is 512.
constexpr std::size_t kLongestPath = 504;

/// Why a database cannot be opened, if its path is the reason.
void RequireShortPath(const std::filesystem::path& file) {
  std::error_code error;
  const std::string whole =
      std::filesystem::weakly_canonical(std::filesystem::absolute(file), error).string();
  if (error || whole.size() <= kLongestPath) return;
  throw InputError(
      fmt::format("{}: its path has {} characters, too many for SQLite", file.string(), whole.size()),
      fmt::format("at most {}", kLongestPath));
}

/// A database of another user, or in an archive. This process may not write it. No other process writes it
/// either: it would have a write-ahead log beside the database.
bool CannotChange(const std::filesystem::path& file) {
  const std::filesystem::path log = file.string() + "-wal";
  std::error_code error;
  if (std::filesystem::exists(log, error) && std::filesystem::file_size(log, error) > 0) return false;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return access(file.c_str(), W_OK) != 0 || access(folder.c_str(), W_OK) != 0;
}

/// Such a database is read without the files that a reader normally creates beside it.
std::string ImmutableUri(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    if (c == '%' || c == '?' || c == '#')
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return uri + "?immutable=1";
}

// SQLite says ENOENT then: it tries to open the file for reading, too. Some file systems count no inodes.
bool HasNoInode(const std::filesystem::path& file) {
  struct statvfs disk {};
  return statvfs(file.parent_path().c_str(), &disk) == 0 && disk.f_files > 0 && disk.f_favail == 0;
}

}  // namespace

Database::Database(const std::filesystem::path& file, Mode mode, std::int64_t page_bytes) : file_(file) {
  // NOMUTEX: one thread at a time uses a connection. A lock for each value of a row took a seventh of a
  // coordinator's time.
  int flags = SQLITE_OPEN_NOMUTEX;
  std::string name = file.string();
  if (mode == Mode::kExisting && CannotChange(file)) {
    flags |= SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
    name = ImmutableUri(file);
  } else {
    flags |= SQLITE_OPEN_READWRITE | (mode == Mode::kCreate ? SQLITE_OPEN_CREATE : 0);
  }
  const int code = sqlite3_open_v2(name.c_str(), &handle_, flags, SqliteFiles());
  try {
    if (code != SQLITE_OK) {
      RequireShortPath(file);
      Fail(code);
    }
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, 10000);
    if (sqlite3_db_readonly(handle_, "main") == 0) {
      if (mode == Mode::kCreate) Execute(fmt::format("PRAGMA page_size = {}", page_bytes));
      Execute("PRAGMA journal_mode = WAL");
      // Commit returns when the data are on the disk. Acknowledged results then survive a power cut.
      Execute("PRAGMA synchronous = FULL");
      Execute("PRAGMA wal_autocheckpoint = 2000");  // pages: 16 MB; each checkpoint waits for the disk
    }
  } catch (...) {
    sqlite3_close_v2(handle_);
    throw;
  }
}

Database::~Database() { sqlite3_close_v2(handle_); }

void Database::Execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) Fail(code);
}

void Database::CopyTo(const std::filesystem::path& file) const {
  const std::filesystem::path temporary = file.string() + ".tmp";
  std::error_code error;
  std::filesystem::remove(temporary, error);  // of a copy that was killed
  {
    Statement page(*this, "PRAGMA page_size");
    page.Step();
    const Database copy(temporary, Mode::kCreate, page.Integer(0));
    sqlite3_backup* backup = sqlite3_backup_init(copy.handle_, "main", handle_, "main");
    if (backup == nullptr) copy.Fail(sqlite3_errcode(copy.handle_));
    constexpr int kAllPages = -1;
    sqlite3_backup_step(backup, kAllPages);
    if (const int code = sqlite3_backup_finish(backup); code != SQLITE_OK) copy.Fail(code);
  }  // closed: its own write-ahead log is in it
  std::filesystem::rename(temporary, file, error);
  if (error) {
    FailFile(file.string(), "cannot be made", error.value());
  }
}

Statement Database::Prepare(const std::string& sql) { return Statement(*this, sql); }

std::uint64_t Database::Count(const std::string& table) {
  Statement select(*this, "SELECT COUNT(*) FROM " + table);
  select.Step();
  return static_cast<std::uint64_t>(select.Integer(0));
}

void Database::Fail(int code) const {
  const int system_error = handle_ != nullptr ? sqlite3_system_errno(handle_) : 0;
  if ((code & 0xff) == SQLITE_FULL) FailFile(file_.string(), "cannot be written", SqliteFullError());
  // A new file without an inode or a descriptor.
  const int lack_of_files = HasNoInode(file_) ? ENOSPC : system_error;
  if ((code & 0xff) == SQLITE_CANTOPEN && DiskFullWords(lack_of_files))
    FailFile(file_.string(), "cannot be opened", lack_of_files);
  if (const char* lack = LackOf(code, system_error)) RefuseFileSystem(file_.string(), lack, system_error);
  throw ResultError(ResultError::Kind::kFile,
                    fmt::format("{}: {}", file_.string(),
                                handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code)));
}

Transaction::Transaction(Database& database) : database_(database) { database_.Execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.Execute("ROLLBACK");
  } catch (const ResultError&) {
    // SQLite has rolled back by itself, as it does when the disk is full.
  }
}

void Transaction::Commit() {
  database_.Execute("COMMIT");
  open_ = false;
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
  Check(sqlite3_prepare_v2(database.handle_, sql.c_str(), -1, &handle_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(handle_); }

void Statement::BindReal(int parameter, double value) {
  // value + 0.0 turns -0 into 0.
  Check(std::isfinite(value) ? sqlite3_bind_double(handle_, parameter, value + 0.0)
                             : sqlite3_bind_null(handle_, parameter));
}

void Statement::BindInteger(int parameter, std::int64_t value) {
  Check(sqlite3_bind_int64(handle_, parameter, value));
}

void Statement::BindText(int parameter, std::string_view value) {
  Check(sqlite3_bind_text64(handle_, parameter, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void Statement::BindBytes(int parameter, std::string_view value) {
  Check(sqlite3_bind_blob64(handle_, parameter, value.data(), value.size(), SQLITE_TRANSIENT));
}

bool Statement::Step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.Fail(code);
  return false;
}

void Statement::Reset() { sqlite3_reset(handle_); }

double Statement::Real(int column) const {
  if (sqlite3_column_type(handle_, column) == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(handle_, column);
}

std::int64_t Statement::Integer(int column) const { return sqlite3_column_int64(handle_, column); }

std::string Statement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return text == nullptr ? std::string()
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column)));
}

void Statement::Check(int code) const {
  if (code != SQLITE_OK) database_.Fail(code);
}

}  // namespace dispersa
