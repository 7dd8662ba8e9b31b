// Files that appear as a whole or not at all.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace dispersa {

/// Writes a file beside the target. On Commit() it replaces the target and takes its permissions. Without
/// Commit() the target stays as it was. A link stays a link: the file that it names is replaced. Pipes and
/// devices are written to directly. The target "-" is standard output, written at once. Throws ResultError
/// (kDiskFull, else kFile).
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void Write(std::string_view bytes);
  void Commit();

 private:
  void OpenTemporary(mode_t mode);
  void OpenDirect();
  [[noreturn]] void Fail(int error) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< empty: the target is written directly
  std::FILE* stream_ = nullptr;
};

/// Writes a whole file at once.
void WriteFile(const std::filesystem::path& target, std::string_view bytes);

/// A whole file. `otherwise`: in the place of one that cannot be read, or is none; without it ResultError.
std::string ReadWholeFile(const std::filesystem::path& file, const char* otherwise = nullptr);

/// The text of a file of lines; empty: there is none. Throws ResultError if it is no regular file.
std::string ReadLines(const std::filesystem::path& file);

/// Adds a line to a file of lines, and makes the file if there is none. No link is followed. The line is on
/// the disk when this returns. Several processes may append. After a line that a killed process cut off a new
/// line begins.
void AppendLine(const std::filesystem::path& file, std::string_view line);

}  // namespace dispersa
