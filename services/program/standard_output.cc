#include "services/program/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/input/disk_full.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

std::string ReasonOf(int error) {
  if (const auto full = DiskFullWords(error)) return ": " + *full;
  if (error == EBADF) return ": it is closed";
  return error == 0 ? "" : std::string(": ") + std::strerror(error);
}

}  // namespace

void PrepareFiles() {
  std::signal(SIGXFSZ, SIG_IGN);
  // Each gets its own number back, the lowest that is free; the one to print to only for reading.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

ExitCode PrintAndEnd(std::string_view text) {
  const bool arrived =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  return arrived ? kExitDone : EndLostOutput(errno);
}

ExitCode EndOutput(ExitCode code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !IsOutputLost()) return code;
  return WorseOf(code, EndLostOutput(errno));
}

ExitCode EndLostOutput(int error) {
  Tell("standard output cannot be written{}\n", ReasonOf(error));
  return kExitIncomplete;
}

bool IsOutputLost() { return std::ferror(stdout) != 0; }

}  // namespace dispersa
