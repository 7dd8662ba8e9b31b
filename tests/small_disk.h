// The output of a child process in which a folder is a small disk of its own, which soon fills up.
#pragma once

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace dispersa {

/// The disk needs a mount namespace. Call it before this process starts a thread.
inline std::string OnASmallDisk(const std::filesystem::path& folder, const std::string& size,
                                const std::function<std::string()>& work) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    std::string said = "no disk of its own";
    const std::string owner = "0 " + std::to_string(geteuid()) + " 1";
    const bool is_root = geteuid() == 0;
    if (unshare(is_root ? CLONE_NEWNS : CLONE_NEWUSER | CLONE_NEWNS) == 0 &&
        (is_root || (std::ofstream("/proc/self/uid_map") << owner).flush()) &&
        mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
        mount("small", folder.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0) {
      try {
        said = work();
      } catch (const std::exception& error) {
        said = std::string("ended with ") + error.what();
      }
    }
    const bool whole = write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size());
    _exit(whole ? 0 : 1);
  }
  close(ends[1]);
  std::string said;
  char part[1000];
  for (ssize_t n; (n = read(ends[0], part, sizeof part)) > 0;) said.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return status == 0 ? said : "the child ended with status " + std::to_string(status);
}

/// Takes all the space that is left, until it is removed.
inline void FillDisk(const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  const std::string part(4096, 'x');
  while (stream.write(part.data(), static_cast<std::streamsize>(part.size())).flush()) {
  }
}

}  // namespace dispersa
