#include "core/results/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/results/file_system.h"
#include "core/results/result_error.h"

namespace dispersa {

namespace {

namespace fs = std::filesystem;

// The file that a name leads to. A link may point to a file that does not exist yet.
fs::path Behind(const fs::path& name) {
  std::error_code error;
  if (!fs::is_symlink(name, error)) return name;
  const fs::path there = fs::canonical(name, error);
  return error ? name.parent_path() / fs::read_symlink(name) : there;
}

/// Closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

// Makes the new name survive a power cut. On file systems that cannot do this, only that protection is
// missing.
void SyncFolderOf(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const Descriptor directory(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory >= 0) (void)SyncFile(directory);
}

constexpr char kUnwritable[] = "cannot be written";

}  // namespace

OutputFile::OutputFile(fs::path target) : target_(std::move(target)) {
  if (target_ == "-") {
    stream_ = stdout;
    return;
  }
  struct stat there {};
  if (stat(target_.c_str(), &there) != 0) {
    OpenTemporary(0);
    return;
  }
  if (S_ISDIR(there.st_mode)) Fail(EISDIR);
  if (access(target_.c_str(), W_OK) != 0) Fail(errno);
  if (S_ISREG(there.st_mode)) OpenTemporary(there.st_mode & 0777);
}

// `mode` is that of the file to be replaced; 0: no such file.
void OutputFile::OpenTemporary(mode_t mode) {
  target_ = Behind(target_);
  temporary_ = target_.string() + ".tmp";
  // An existing file is left from a killed process, or was put there. If it is a link, it would redirect the
  // writing.
  if (unlink(temporary_.c_str()) != 0 && errno != ENOENT) Fail(errno);
  // The permissions are never wider than those of the file to be replaced, not even while the new file is
  // empty.
  const int file =
      open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode != 0 ? mode : 0666);
  if (file < 0) Fail(errno);
  stream_ = fdopen(file, "wb");
  if (mode != 0 && fchmod(file, mode) != 0) Fail(errno);
}

// Opened at the first write: opening a pipe waits for its reader.
void OutputFile::OpenDirect() {
  const int file = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) Fail(errno);
  stream_ = fdopen(file, "wb");
}

OutputFile::~OutputFile() {
  if (stream_ == stdout) return;
  if (stream_ != nullptr) std::fclose(stream_);
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);  // no more there after a commit
}

void OutputFile::Write(std::string_view bytes) {
  if (stream_ == nullptr) OpenDirect();
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) Fail(errno);
}

void OutputFile::Commit() {
  if (stream_ == nullptr) OpenDirect();
  if (std::fflush(stream_) != 0) Fail(errno);
  if (stream_ == stdout) return;
  if (const int error = temporary_.empty() ? 0 : SyncFile(fileno(stream_))) Fail(error);
  std::FILE* stream = std::exchange(stream_, nullptr);
  if (std::fclose(stream) != 0) Fail(errno);
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) Fail(errno);
  SyncFolderOf(target_);
}

void OutputFile::Fail(int error) const {
  FailFile(stream_ == stdout ? "standard output" : target_.string(), kUnwritable, error);
}

void WriteFile(const std::filesystem::path& target, std::string_view bytes) {
  OutputFile file(target);
  file.Write(bytes);
  file.Commit();
}

std::string ReadWholeFile(const fs::path& file, const char* otherwise) {
  std::error_code error;
  std::ifstream stream;
  if (fs::is_regular_file(file, error)) stream.open(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();  // character by character took longer than the flights of a small campaign
  if (stream.is_open() && stream) return std::move(text).str();
  if (otherwise != nullptr) return otherwise;
  throw ResultError(ResultError::Kind::kFile, file.string() + ": cannot be read");
}

std::string ReadLines(const fs::path& file) {
  const Descriptor descriptor(OpenRegular(file, O_RDONLY));
  std::string text;
  for (char part[1 << 16]; descriptor >= 0;) {
    const ssize_t count = read(descriptor, part, sizeof part);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) FailFile(file.string(), "cannot be read", errno);
    if (count == 0) break;
    text.append(part, static_cast<std::size_t>(count));
  }
  return text;
}

void AppendLine(const fs::path& file, std::string_view line) {
  const Descriptor descriptor(OpenRegular(file, O_RDWR | O_CREAT | O_APPEND));
  LockFile(descriptor, true, file);
  char last = '\n';
  const off_t size = lseek(descriptor, 0, SEEK_END);
  if (size > 0) (void)!pread(descriptor, &last, 1, size - 1);
  std::string text(last == '\n' ? "" : "\n");
  text.append(line).append("\n");
  const ssize_t written = write(descriptor, text.data(), text.size());
  int error = written == std::ssize(text) ? 0 : (written < 0 ? errno : ENOSPC);
  if (error == 0) error = SyncFile(descriptor);
  if (error != 0 && size >= 0) (void)!ftruncate(descriptor, size);  // a part of a line is none
  if (error != 0) FailFile(file.string(), kUnwritable, error);
  if (size <= 0) SyncFolderOf(file);
}

}  // namespace dispersa
