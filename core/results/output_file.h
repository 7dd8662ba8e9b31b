// Files that appear as a whole or not at all.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace dispersa {

/// Writes beside the target and takes its place on Commit(), with its permissions; without it the target
/// stays as it was. A link stays one: what it names is replaced. A pipe or a device is no file to take the
/// place of: it is written to. The target "-" is standard output, written at once. Throws ResultError
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
  std::filesystem::path temporary_;  ///< empty: what is there is written to
  std::FILE* stream_ = nullptr;
};

/// A whole file at once.
void WriteFile(const std::filesystem::path& target, std::string_view bytes);

}  // namespace dispersa
