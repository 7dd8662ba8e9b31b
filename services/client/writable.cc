#include "services/client/writable.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/input/input_error.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"

namespace dispersa {

namespace fs = std::filesystem;

void RequireWritableFile(const std::string& option, const fs::path& path) {
  if (path.empty() || path == "-") return;
  const auto refuse = [&](const std::string& why, const std::string& allowed) {
    throw InputError(option + ": " + path.string() + " cannot be written: " + why, allowed);
  };
  std::error_code error;
  if (fs::is_directory(path, error)) refuse("it is a folder", "a file");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    refuse("there is no folder " + folder.string(), "a file in a folder that exists");
  try {
    const OutputFile probe(path);
  } catch (const ResultError&) {
    refuse(std::strerror(errno), "a file in a folder that can be written");
  }
}

void RequireWritableFolder(const std::string& option, const fs::path& path) {
  if (path.empty()) return;
  const auto refuse = [&](const fs::path& place, const std::string& why) {
    throw InputError(option + ": " + path.string() + " cannot be written: " + place.string() + ": " + why,
                     "an existing or new folder that can be written");
  };
  // A missing folder is made in the nearest existing folder above it.
  std::error_code error;
  fs::path place = fs::absolute(path).lexically_normal();
  while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  if (!fs::is_directory(place, error)) refuse(place, std::strerror(ENOTDIR));
  if (access(place.c_str(), W_OK | X_OK) != 0) refuse(place, std::strerror(errno));
}

}  // namespace dispersa
