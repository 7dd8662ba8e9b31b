#include "core/report/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/report/result_error.h"

namespace dispersa {

OutputFile::OutputFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(target_.string() + ".tmp") {
  if (target_ == "-") {
    stream_ = stdout;
    return;
  }
  // What lies there is of a process that was killed, or was put there: a link would lead the writing elsewhere.
  if (unlink(temporary_.c_str()) != 0 && errno != ENOENT) Fail(errno);
  const int file = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) Fail(errno);
  stream_ = fdopen(file, "wb");
}

OutputFile::~OutputFile() {
  if (stream_ == stdout) return;
  if (stream_ != nullptr) std::fclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);  // no more there after a commit
}

void OutputFile::Write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) Fail(errno);
}

void OutputFile::Commit() {
  if (stream_ == stdout) {
    if (std::fflush(stdout) != 0) Fail(errno);
    return;
  }
  if (std::fflush(stream_) != 0 || fsync(fileno(stream_)) != 0) Fail(errno);
  std::FILE* stream = std::exchange(stream_, nullptr);
  if (std::fclose(stream) != 0 || std::rename(temporary_.c_str(), target_.c_str()) != 0) Fail(errno);
}

void OutputFile::Fail(int error) const {
  if (error == ENOSPC || error == EDQUOT) {
    throw ResultError(ResultError::Kind::kDiskFull,
                      fmt::format("{}: no space left on the disk", target_.string()));
  }
  throw ResultError(ResultError::Kind::kFile,
                    fmt::format("{}: cannot be written: {}", target_.string(), std::strerror(error)));
}

void WriteFile(const std::filesystem::path& target, std::string_view bytes) {
  OutputFile file(target);
  file.Write(bytes);
  file.Commit();
}

}  // namespace dispersa
