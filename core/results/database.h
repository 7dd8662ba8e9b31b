// SQLite with errors as ResultError. Only core/results includes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

struct sqlite3;
struct sqlite3_stmt;

namespace dispersa {

class Statement;

/// One connection, used by one thread at a time. A committed transaction survives a killed process and a
/// power cut (WAL, synchronous FULL). Waits up to 10 s for another process's lock. Needs a file system with
/// locks and shared memory.
class Database {
 public:
  enum class Mode { kCreate, kExisting };

  /// Of a new file: a dozen rows of a campaign fill a page to more than nine tenths.
  static constexpr std::int64_t kPageBytes = 8192;

  /// InputError if the path is too long for SQLite. `page_bytes`: of a file that is created.
  Database(const std::filesystem::path& file, Mode mode, std::int64_t page_bytes = kPageBytes);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void Execute(const std::string& sql);
  Statement Prepare(const std::string& sql);
  /// The number of rows of a table.
  std::uint64_t Count(const std::string& table);
  /// Replaces `file` by a copy of everything committed, including the write-ahead log. Other processes may
  /// read and write meanwhile.
  void CopyTo(const std::filesystem::path& file) const;
  /// Throws the error that the connection reports for a result code.
  [[noreturn]] void Fail(int code) const;

 private:
  friend class Statement;

  std::filesystem::path file_;
  sqlite3* handle_ = nullptr;
};

/// Rolled back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void Commit();

 private:
  Database& database_;
  bool open_ = true;
};

/// A prepared statement. Parameters count from 1, columns from 0, as in SQLite.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Not finite becomes NULL, -0 becomes 0.
  void BindReal(int parameter, double value);
  void BindInteger(int parameter, std::int64_t value);
  void BindText(int parameter, std::string_view value);
  void BindBytes(int parameter, std::string_view value);

  /// Begins anew with numbers and texts for the first parameters. True if there is a row.
  template <typename... Values>
  bool Run(const Values&... values) {
    Reset();
    int parameter = 0;
    (Bind(++parameter, values), ...);
    return Step();
  }
  /// True while there is a row.
  bool Step();
  /// Ready for the next parameters.
  void Reset();

  /// NULL is NaN.
  double Real(int column) const;
  std::int64_t Integer(int column) const;
  /// Also of bytes.
  std::string Text(int column) const;

 private:
  template <typename Value>
  void Bind(int parameter, const Value& value) {
    if constexpr (std::is_floating_point_v<Value>) {
      BindReal(parameter, value);
    } else if constexpr (std::is_integral_v<Value>) {
      BindInteger(parameter, static_cast<std::int64_t>(value));
    } else {
      BindText(parameter, value);
    }
  }
  void Check(int code) const;

  const Database& database_;
  sqlite3_stmt* handle_ = nullptr;
};

}  // namespace dispersa
