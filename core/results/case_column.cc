#include "core/results/case_column.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "core/math/assertion.h"
#include "core/results/file_system.h"

namespace dispersa {
namespace {

/// A block of 200 columns is 13 MB.
constexpr std::size_t kBlockRows = 8192;

[[noreturn]] void Fail(const std::filesystem::path& directory, int error) {
  FailFile(directory.string(), "columns of results cannot be kept there", error);
}

/// A file without a name, so that it is removed even if the process is killed.
int OpenUnnamed(const std::filesystem::path& directory) {
  const int file = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  // Not every file system supports unnamed files.
  std::string name = (directory / ".columns-XXXXXX").string();
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

}  // namespace

ColumnFile::ColumnFile(std::filesystem::path directory, std::size_t columns)
    : directory_(std::move(directory)), columns_(columns), block_(columns * kBlockRows) {}

ColumnFile::~ColumnFile() {
  if (file_ >= 0) close(file_);
}

void ColumnFile::Append(const std::vector<double>& row) {
  DISPERSA_ASSERT(row.size() == columns_, row.size());
  const std::size_t in_block = rows_ % kBlockRows;
  if (in_block == 0 && rows_ > 0) WriteBlock();
  for (std::size_t i = 0; i < columns_; ++i) block_[i * kBlockRows + in_block] = row[i];
  ++rows_;
}

void ColumnFile::WriteBlock() {
  if (file_ < 0) {
    file_ = OpenUnnamed(directory_);
    if (file_ < 0) {
      directory_ = std::filesystem::temp_directory_path();
      file_ = OpenUnnamed(directory_);
    }
    if (file_ < 0) Fail(directory_, errno);
  }
  const auto* bytes = reinterpret_cast<const char*>(block_.data());
  for (std::size_t left = block_.size() * sizeof(double); left > 0;) {
    const ssize_t written = write(file_, bytes, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) Fail(directory_, errno);
    bytes += written;
    left -= static_cast<std::size_t>(written);
  }
}

std::vector<double> ColumnFile::Read(std::size_t column) const {
  DISPERSA_ASSERT(column < columns_, column);
  std::vector<double> values(rows_);
  for (std::size_t first = 0; first < rows_; first += kBlockRows) {
    const std::size_t count = std::min(kBlockRows, rows_ - first);
    if (first + count == rows_) {  // the last block has not been written
      const auto begin = block_.begin() + static_cast<std::ptrdiff_t>(column * kBlockRows);
      std::copy_n(begin, count, values.begin() + static_cast<std::ptrdiff_t>(first));
      break;
    }
    auto* bytes = reinterpret_cast<char*>(values.data() + first);
    auto offset = static_cast<off_t>((first * columns_ + column * kBlockRows) * sizeof(double));
    for (std::size_t left = count * sizeof(double); left > 0;) {
      const ssize_t got = pread(file_, bytes, left, offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) Fail(directory_, got < 0 ? errno : EIO);
      bytes += got;
      offset += got;
      left -= static_cast<std::size_t>(got);
    }
  }
  return values;
}

}  // namespace dispersa
