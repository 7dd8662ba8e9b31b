#include "services/coordinator/packed_files.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <system_error>

#include "core/pages/report_sums.h"
#include "core/results/file_system.h"
#include "core/results/gzip.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kPacked[] = ".gz";
constexpr char kPage[] = "report.html";

struct CloseGz {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzFile = std::unique_ptr<gzFile_s, CloseGz>;

fs::path Packed(const fs::path& file) { return file.string() + kPacked; }

[[noreturn]] void FailRead(const fs::path& file) {
  throw ResultError(ResultError::Kind::kFile, file.string() + ": cannot be read");
}

bool IsPacked(const fs::path& file) {
  std::error_code error;
  return !fs::exists(file, error) && fs::exists(Packed(file), error);
}

}  // namespace

void PackReports(const fs::path& results) {
  const fs::path page = results / kPage;
  std::error_code error;
  if (!fs::exists(page, error)) return;
  WriteFile(Packed(page), Gzip(ReadWholeFile(page)));
  fs::remove(page);
}

void RemoveReports(const fs::path& results) {
  for (const char* name : {"cases.csv", "nominal.json", "summary.json", kPage, "histories", kSumsName}) {
    for (const fs::path& file : {results / name, Packed(results / name)}) {
      std::error_code error;
      fs::remove_all(file, error);
      if (error) FailFile(file.string(), "cannot be removed", error.value());
    }
  }
}

std::vector<fs::path> StoredFilesIn(const fs::path& results) {
  std::vector<fs::path> files;
  if (!fs::is_directory(results)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(results)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_symlink() || !entry.is_regular_file() || name.ends_with(".tmp") || name.ends_with("-wal") ||
        name.ends_with("-shm")) {
      continue;
    }
    files.push_back(entry.path().lexically_relative(results));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> FilesIn(const fs::path& results) {
  std::vector<fs::path> files = StoredFilesIn(results);
  for (fs::path& file : files)
    if (file == Packed(kPage)) file.replace_extension();
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

// gzip keeps the size of the text in the last four bytes.
std::uint64_t SizeOf(const fs::path& file) {
  std::error_code error;
  if (!IsPacked(file)) {
    const std::uint64_t size = fs::file_size(file, error);
    if (error) FailRead(file);
    return size;
  }
  std::ifstream stream(Packed(file), std::ios::binary);
  std::array<unsigned char, 4> size{};
  stream.seekg(-4, std::ios::end);
  if (!stream.read(reinterpret_cast<char*>(size.data()), size.size())) FailRead(file);
  return size[0] | std::uint64_t{size[1]} << 8 | std::uint64_t{size[2]} << 16 | std::uint64_t{size[3]} << 24;
}

std::string ReadPart(const fs::path& file, std::uint64_t offset, std::size_t most) {
  // gzread reads a file that is not compressed as it is, but so does not tell it from a damaged one.
  std::string part(most, '\0');
  if (!IsPacked(file)) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) FailRead(file);
    stream.seekg(static_cast<std::streamoff>(offset));
    stream.read(part.data(), static_cast<std::streamsize>(most));
    part.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
    return part;
  }
  const GzFile packed(gzopen(Packed(file).c_str(), "rb"));
  if (!packed || gzseek(packed.get(), static_cast<z_off_t>(offset), SEEK_SET) < 0) FailRead(file);
  const int count = gzread(packed.get(), part.data(), static_cast<unsigned>(most));
  if (count < 0) FailRead(file);
  part.resize(static_cast<std::size_t>(count));
  return part;
}

}  // namespace dispersa
