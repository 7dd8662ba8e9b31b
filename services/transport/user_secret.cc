#include "services/transport/user_secret.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "services/transport/network.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kAllowedSecret[] = "a file of this user alone (permissions 600), --keys, or --insecure";

[[noreturn]] void RefuseSecret(const fs::path& file, const std::string& problem) {
  throw NetworkError(file.string() + ": " + problem + ", allowed: " + kAllowedSecret);
}

std::optional<Secret> ReadSecret(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor < 0) RefuseSecret(file, std::string("cannot be read: ") + std::strerror(errno));
  struct stat what {};
  Secret secret{};
  char beyond = 0;
  const bool is_known = fstat(descriptor, &what) == 0 && S_ISREG(what.st_mode);
  const bool is_whole =
      is_known && read(descriptor, secret.data(), secret.size()) == static_cast<ssize_t>(secret.size()) &&
      read(descriptor, &beyond, 1) == 0;
  close(descriptor);
  if (is_known && what.st_uid != geteuid()) RefuseSecret(file, "it belongs to another user");
  if (is_known && (what.st_mode & 077) != 0)
    RefuseSecret(file, fmt::format("others may use it (permissions {:o})", what.st_mode & 0777));
  if (!is_whole) RefuseSecret(file, "it holds no secret of 32 bytes");
  return secret;
}

/// It appears as a whole, and never in the place of another one.
void MakeSecret(const fs::path& file) {
  if (mkdir(file.parent_path().c_str(), 0700) != 0 && errno != EEXIST)
    RefuseSecret(file, std::string("its folder cannot be made: ") + std::strerror(errno));
  std::string draft = file.string() + ".XXXXXX";
  const int descriptor = mkostemp(draft.data(), O_CLOEXEC);  // with permissions 600
  const Secret secret = DrawSecret();
  const bool is_written =
      descriptor >= 0 &&
      write(descriptor, secret.data(), secret.size()) == static_cast<ssize_t>(secret.size()) &&
      fsync(descriptor) == 0 && (link(draft.c_str(), file.c_str()) == 0 || errno == EEXIST);
  const int error = errno;
  if (descriptor >= 0) {
    close(descriptor);
    unlink(draft.c_str());
  }
  if (!is_written) RefuseSecret(file, std::string("cannot be made: ") + std::strerror(error));
}

}  // namespace

fs::path UserSecretFile() {
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') {
    const passwd* user = getpwuid(geteuid());
    home = user != nullptr ? user->pw_dir : nullptr;
  }
  if (home == nullptr || *home != '/') {
    throw NetworkError(
        std::string("this user has no home folder for the secret of its programs, allowed: HOME, --keys, ") +
        "or --insecure");
  }
  return fs::path(home) / ".dispersa" / "secret";
}

Secret OpenUserSecret(const fs::path& file) {
  if (const auto secret = ReadSecret(file)) return *secret;
  MakeSecret(file);
  if (const auto secret = ReadSecret(file)) return *secret;
  RefuseSecret(file, "it is gone again");
}

}  // namespace dispersa
