#include "core/containment/foreign_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "core/containment/frames.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kProgram[] = "dispersa-foreign";
constexpr int kSocket = 3;  // in that program
constexpr int kExecFailed = 127;
// Larger than any campaign, and than what a child may allocate.
constexpr std::size_t kMostBytes = std::size_t{1} << 31;

// In dispersa-foreign itself.
bool is_foreign_program = false;

std::atomic<bool> is_ending = false;

int foreign_output = STDERR_FILENO;

// Beside the program or library that has this function, or in the folder bin of one above it: the programs of
// a build or an installation, its tests and its Python package lie so.
fs::path FindProgram() {
  Dl_info here{};
  std::error_code error;
  fs::path file = fs::read_symlink("/proc/self/exe", error);
  if (dladdr(reinterpret_cast<void*>(&FindProgram), &here) != 0 && here.dli_fname != nullptr &&
      fs::path(here.dli_fname).is_absolute() && fs::path(here.dli_fname).extension() == ".so")
    file = fs::weakly_canonical(here.dli_fname, error);
  fs::path folder = file.parent_path();
  if (access((folder / kProgram).c_str(), X_OK) == 0) return folder / kProgram;
  for (int levels = 0; levels < 5 && folder.has_relative_path(); ++levels, folder = folder.parent_path())
    if (access((folder / "bin" / kProgram).c_str(), X_OK) == 0) return folder / "bin" / kProgram;
  throw PluginError(std::string("is a plug-in, which flies in the program ") + kProgram +
                    ", and that is not installed beside this one");
}

// The engine's lanes, and the fault of a test's build.
std::vector<std::string> Environment() {
  std::vector<std::string> environment;
  for (const char* name : {"DISPERSA_ISA", "DISPERSA_LANES", "DISPERSA_FAULT"})
    if (const char* value = std::getenv(name)) environment.push_back(std::string(name) + "=" + value);
  return environment;
}

std::vector<char*> Pointers(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Between fork and exec of a process with threads: only what is safe in a signal handler.
[[noreturn]] void BecomeForeign(const char* program, char* const* words, char* const* environment,
                                int socket) {
  if (foreign_output != STDERR_FILENO) dup2(foreign_output, STDERR_FILENO);  // it may be the number below
  if (socket == kSocket) {
    fcntl(kSocket, F_SETFD, 0);
  } else {
    dup2(socket, kSocket);
  }
  close_range(kSocket + 1, ~0u, 0);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing > STDIN_FILENO) dup2(nothing, STDIN_FILENO), close(nothing);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  if (chdir("/") != 0) _exit(kExecFailed);
  execve(program, words, environment);
  _exit(kExecFailed);
}

bool SendAll(int socket, const char* at, std::size_t size) {
  while (size > 0) {
    const ssize_t part = send(socket, at, size, MSG_NOSIGNAL);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return false;
    at += part;
    size -= static_cast<std::size_t>(part);
  }
  return true;
}

}  // namespace

ForeignProcess::ForeignProcess() {
  std::vector<std::string> words = {FindProgram().string()}, environment = Environment();
  const std::vector<char*> word_pointers = Pointers(words), variables = Pointers(environment);
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) Fail(std::strerror(errno));
  socket_ = ends[0];
  pid_ = fork();
  if (pid_ == 0) BecomeForeign(word_pointers[0], word_pointers.data(), variables.data(), ends[1]);
  const int error = errno;
  close(ends[1]);
  if (pid_ < 0) Fail(std::strerror(error));
}

ForeignProcess::~ForeignProcess() {
  if (socket_ >= 0) close(socket_);
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
}

void ForeignProcess::Fail(const std::string& why) {
  is_usable_ = false;
  if (socket_ >= 0) close(std::exchange(socket_, -1));
  throw NoChild("no process for a control law can be started: " + why);
}

void ForeignProcess::Ask(const std::string& order, const Say& hear, const StopCheck& should_stop) {
  is_usable_ = false;
  const std::uint64_t size = order.size();
  const std::string head =
      std::string(1, kSaid) + std::string(reinterpret_cast<const char*>(&size), sizeof size);
  if (!SendAll(socket_, head.data(), head.size()) || !SendAll(socket_, order.data(), order.size()))
    Fail(std::string(kProgram) + " does not listen");
  FrameReader frames(kMostBytes);
  for (bool is_open = true; is_open && !frames.is_spoilt();) {
    if (is_ending || (should_stop && should_stop())) throw Interrupted();
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, 100) <= 0) continue;
    is_open = frames.ReadFrom(socket_);
    while (const std::optional<Frame> frame = frames.Next()) {
      if (frame->kind == kSaid) {
        hear(frame->bytes);
        continue;
      }
      if (frame->kind == kUnheld) throw NoChild(frame->bytes);
      is_usable_ = true;
      if (frame->kind == kDone) return;
      if (frame->kind == kProblem) throw PluginError(frame->bytes);
      std::string how;
      const PluginMark at = UnpackEnd(frame->bytes, &how);
      throw ContainedEnd(how, at);
    }
  }
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) == pid_) pid_ = -1;
  Fail(WIFEXITED(status) && WEXITSTATUS(status) == kExecFailed ? std::string(kProgram) + " cannot be executed"
                                                               : std::string(kProgram) + " ended");
}

void SendForeignOutputTo(int file) { foreign_output = file; }

void EndForeignProcesses() { is_ending = true; }

PluginDescription DescribePlugin(const PluginConfig& config) {
  if (is_foreign_program) return DescribeContained(config);
  std::vector<std::string> texts;
  ForeignProcess().Ask(kDescribeOrder + *config.library,
                       [&](const std::string& text) { texts.push_back(text); });
  return DescriptionOf(texts);
}

void ServeOrders(const AnswerOrder& answer) {
  is_foreign_program = true;
  // The parent decides what an interrupt means: its end, or the end of the socket, is the end of this
  // process.
  setpgid(0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  fcntl(kSocket, F_SETFD, FD_CLOEXEC);
  const auto is_alone = [] {
    pollfd parent{kSocket, POLLRDHUP, 0};
    return poll(&parent, 1, 0) > 0;
  };
  const auto tell = [](char kind, const std::string& bytes) {
    if (!WriteFrame(kSocket, kind, bytes)) _exit(1);
  };
  const Say say = [&](const std::string& message) { tell(kSaid, message); };
  FrameReader orders(kMostBytes);
  for (;;) {
    const std::optional<Frame> order = orders.Next();
    if (!order) {
      if (orders.is_spoilt() || !orders.ReadFrom(kSocket)) return;
      continue;
    }
    try {
      answer(order->bytes, say, is_alone);
      tell(kDone, "");
    } catch (const PluginError& error) {
      tell(kProblem, error.what());
    } catch (const ContainedEnd& end) {
      tell(kEnded, PackEnd(end.at(), end.what()));
    } catch (const Interrupted&) {
      return;
    } catch (const std::exception& error) {
      tell(kUnheld, error.what());
    }
  }
}

}  // namespace dispersa
