#include "services/cli/render_template.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/input/input_error.h"
#include "services/cli/render_template_script.h"

extern char** environ;

namespace dispersa {
namespace {

constexpr int kNoJinja = 77;
constexpr int kBadTemplate = 2;

struct Ended {
  int code = 0;
  std::string output;
};

/// Runs a program to its end and keeps what it writes to standard output. Code 77 when there is no such
/// program.
Ended Run(const std::vector<std::string>& words) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int problem = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (problem != 0) {
    close(ends[0]);
    return {kNoJinja, ""};
  }
  Ended ended;
  char buffer[65536];
  for (;;) {
    const ssize_t got = read(ends[0], buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    ended.output.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  return ended;
}

}  // namespace

std::string RenderTemplate(const std::filesystem::path& summary, const std::filesystem::path& template_file) {
  for (const auto& file : {template_file, summary}) {
    if (!std::filesystem::exists(file))
      throw InputError(file.string() + ": file not found", "a file that exists");
    if (!std::ifstream(file) || std::filesystem::is_directory(file))
      throw InputError(file.string() + ": cannot be read", "a readable file");
  }
  // Debian's python first: python3-jinja2 belongs to it. Another python3 may come first in the path.
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    Ended ended = Run({python, "-I", "-c", kRenderTemplateScript, summary.string(), template_file.string()});
    if (ended.code == kNoJinja) continue;
    if (ended.code == 0) return std::move(ended.output);
    if (ended.code != kBadTemplate)
      throw std::runtime_error("the template engine ended with code " + std::to_string(ended.code));
    ended.output.erase(ended.output.find_last_not_of('\n') + 1);
    throw InputError(ended.output);
  }
  throw InputError("--template: python3 with jinja2 is not installed", "the Debian package python3-jinja2");
}

}  // namespace dispersa
