#include "core/containment/contained.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/containment/frames.h"
#include "core/input/printable.h"

namespace dispersa {
namespace {

std::string refusal = WhyNoSandbox();
std::set<std::string> not_refused;

// The restrictions that the kernel granted to this process. Read in a child.
SandboxParts sandbox;

// Nobody listens any more: the process has nothing to do.
void Tell(char kind, const std::string& bytes) {
  if (!WriteFrame(kAnswers, kind, bytes)) _exit(1);
}

// One byte, and with it a file if there is one. In a socket.
struct FileMessage {
  char byte = 0;
  iovec data{&byte, 1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr head{nullptr, 0, &data, 1, control, sizeof control, 0};
};

bool SendFile(int socket, int file) {
  FileMessage message;
  if (file < 0) {
    message.head.msg_controllen = 0;
  } else {
    cmsghdr* const about = CMSG_FIRSTHDR(&message.head);
    *about = {CMSG_LEN(sizeof file), SOL_SOCKET, SCM_RIGHTS};
    std::memcpy(CMSG_DATA(about), &file, sizeof file);
  }
  return sendmsg(socket, &message.head, MSG_NOSIGNAL) == 1;
}

int ReceiveFile(int socket) {
  FileMessage message;
  int file = -1;
  while (recvmsg(socket, &message.head, MSG_CMSG_CLOEXEC) < 0 && errno == EINTR) continue;
  const cmsghdr* const about = CMSG_FIRSTHDR(&message.head);
  if (about != nullptr && about->cmsg_type == SCM_RIGHTS) std::memcpy(&file, CMSG_DATA(about), sizeof file);
  return file;
}

std::size_t VirtualBytes() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void Limit(int resource, rlim_t value) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY || value < limit.rlim_max ? value : limit.rlim_max;
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// In a signal handler: a text so short is not allocated.
void TellAskedCall(int call) {
  Tell(kAsked, std::string(reinterpret_cast<const char*>(&call), sizeof call));
  _exit(1);
}

[[noreturn]] void BeChild(int out, int prints, pid_t parent, volatile PluginMark* mark,
                          const ContainmentLimits& limits, const std::function<void(const Say& say)>& work) {
  MarkPluginCallsIn(mark);
  setpgid(0, 0);
  // An exit within a call destroys nothing of the parent's: handlers run in the reverse order of their
  // registration.
  on_exit([](int status, void*) { _exit(status); }, nullptr);
  // The parent decides what an interrupt means. Other signals mean what they do.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE}) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  // The plug-in gets no file of this process, and its printed output is no result.
  dup2(prints, STDOUT_FILENO);
  dup2(prints, STDERR_FILENO);
  if (out != kAnswers) dup2(out, kAnswers);
  fcntl(kAnswers, F_SETFD, FD_CLOEXEC);
  close_range(kAnswers + 1, ~0u, 0);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO), close(nothing);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_AS, VirtualBytes() + limits.memory_bytes);
  int listener = -1;
  sandbox = EnterSandbox(limits.sandbox, TellAskedCall, &listener);
  if (!SendFile(kAnswers, listener)) _exit(1);
  close(listener);
  if (!sandbox.seccomp) {
    Tell(kUnheld, std::strerror(errno));
    _exit(1);
  }
  if (getppid() != parent) _exit(1);
  try {
    work([](const std::string& message) { Tell(kSaid, message); });
    Tell(kDone, "");
  } catch (const PluginError& error) {
    Tell(kProblem, error.what());
  } catch (const std::exception& error) {
    Tell(kThrew, error.what());
  } catch (...) {
    Tell(kThrew, "no std::exception");
  }
  _exit(0);  // nothing of the parent's is destroyed here
}

std::string HowItEnded(int status, const ContainmentLimits& limits) {
  if (!WIFSIGNALED(status)) return "ended the process with exit code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  const char* const name = sigabbrev_np(signal);
  const std::string text =
      "ended by signal " + std::to_string(signal) + (name ? " (SIG" + std::string(name) + ")" : "");
  // A C library that forks with all signals blocked lets no handler name the call.
  if (signal == SIGSYS) return text + ", after a system call that it may not make";
  // Ends that a lack of memory may cause.
  const bool is_of_memory = signal == SIGABRT || signal == SIGSEGV || signal == SIGKILL;
  return is_of_memory
             ? text + ", in a process that may allocate " + std::to_string(limits.memory_bytes >> 20) + " MiB"
             : text;
}

std::string AskedCall(const std::string& message) {
  int call = 0;
  std::memcpy(&call, message.data(), std::min(sizeof call, message.size()));
  return "was refused the system call '" + SystemCallName(call) + "'";
}

std::string Place(const PluginMark& at) {
  if (at.stage < 0) return "";
  char text[64];
  std::snprintf(text, sizeof text, " at %.3f s, in stage %d", at.time_s, at.stage + 1);
  return text;
}

double CpuSeconds(clockid_t clock) {
  timespec now{};
  if (clock_gettime(clock, &now) != 0) return 0.0;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Whether the call that a mark shows has taken too long.
class CallWatch {
 public:
  CallWatch(pid_t child, const volatile PluginMark& mark, const ContainmentLimits& limits)
      : mark_(mark), limits_(limits) {
    if (clock_getcpuclockid(child, &clock_) != 0) clock_ = CLOCK_MONOTONIC;
  }
  bool TookTooLong() {
    const std::uint64_t calls = mark_.calls;
    const auto now = std::chrono::steady_clock::now();
    const double cpu_s = CpuSeconds(clock_);
    // While this process was stopped, so was the child.
    waited_s_ += std::min(std::chrono::duration<double>(now - looked_).count(), 0.5);
    looked_ = now;
    if (!at_end_ && (calls != calls_ || calls % 2 == 0)) {
      calls_ = calls;
      waited_s_ = 0.0;
      since_cpu_s_ = cpu_s;
      return false;
    }
    return cpu_s - since_cpu_s_ > limits_.call_cpu_s || waited_s_ > limits_.call_wait_s;
  }
  /// From now on the child has nothing to do but to end.
  void AwaitEnd() { at_end_ = true; }

 private:
  const volatile PluginMark& mark_;
  const ContainmentLimits limits_;
  clockid_t clock_ = CLOCK_MONOTONIC;
  std::uint64_t calls_ = 0;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  double waited_s_ = 0.0;
  double since_cpu_s_ = 0.0;
  bool at_end_ = false;
};

// A child, which does not outlive this object.
class Child {
 public:
  Child(const std::function<void(const Say& say)>& work, const ContainmentLimits& limits) {
    void* const shared =
        mmap(nullptr, sizeof(PluginMark), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) Refuse();
    mark_ = new (shared) PluginMark();
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) Refuse();
    in_ = ends[0];
    int prints[2];
    if (pipe2(prints, O_CLOEXEC) != 0) {
      close(ends[1]);
      Refuse();
    }
    prints_ = prints[0];
    fcntl(prints_, F_SETFL, O_NONBLOCK);
    const pid_t parent = getpid();
    std::fflush(nullptr);
    pid_ = fork();
    if (pid_ == 0) BeChild(ends[1], prints[1], parent, mark_, limits, work);
    const int error = errno;
    close(ends[1]);
    close(prints[1]);
    errno = error;
    if (pid_ < 0) Refuse();
    setpgid(pid_, pid_);  // whichever of the two comes first: signals of a terminal are the parent's
    listener_ = ReceiveFile(in_);
  }
  ~Child() { End(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  int in() const { return in_; }
  /// What it prints, to be read without waiting.
  int prints() const { return prints_; }
  /// Of its calls with a path (sandbox.h). -1: none.
  int listener() const { return listener_; }
  const volatile PluginMark& mark() const { return *mark_; }
  PluginMark At() const { return {mark_->case_index, mark_->calls, mark_->time_s, mark_->stage}; }
  /// How it has ended; none while it runs.
  std::optional<int> Ended() {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
    pid_ = -1;
    return status;
  }

 private:
  [[noreturn]] void Refuse() {
    const std::string reason = std::strerror(errno);
    End();
    throw NoChild("no process for a control law can be started: " + reason);
  }
  void End() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
    }
    for (const int file : {in_, prints_, listener_})
      if (file >= 0) close(file);
    if (mark_ != nullptr) munmap(const_cast<PluginMark*>(mark_), sizeof(PluginMark));
  }

  volatile PluginMark* mark_ = nullptr;
  pid_t pid_ = -1;
  int in_ = -1;
  int prints_ = -1;
  int listener_ = -1;
};

// Shows what a child prints on the standard error: whole lines of printable ASCII, and not without end.
class Prints {
 public:
  explicit Prints(int file) : file_(file) {}
  ~Prints() {
    Read();
    if (!line_.empty()) Show(line_);
  }
  Prints(const Prints&) = delete;
  Prints& operator=(const Prints&) = delete;

  /// -1 at its end.
  int file() const { return file_; }
  /// What is there.
  void Read() {
    char part[4096];
    ssize_t size = 1;
    // At most what a pipe holds: the child may write on for ever.
    for (int parts = 0; file_ >= 0 && parts < 16 && size > 0; ++parts) {
      size = read(file_, part, sizeof part);
      if (size <= 0) break;
      for (const char c : std::string_view(part, static_cast<std::size_t>(size))) {
        if (c == '\n') {
          Show(std::exchange(line_, {}));
        } else if (line_.size() <= kLine) {
          line_ += c;
        }
      }
    }
    if (size == 0) file_ = -1;
  }

 private:
  static constexpr std::size_t kLine = 1000, kAll = 64 << 10;

  void Show(const std::string& line) {
    if (shown_ > kAll) return;
    std::string text = Printable(line, kLine) + "\n";
    shown_ += text.size();
    if (shown_ > kAll) text = "the control law prints more, which is not shown\n";
    std::fwrite(text.data(), 1, text.size(), stderr);
  }

  int file_;
  std::string line_;
  std::size_t shown_ = 0;
};

}  // namespace

void RunContained(const std::function<void(const Say& say)>& work, const Say& hear,
                  const StopCheck& should_stop, const ContainmentLimits& limits) {
  Child child(work, limits);
  CallWatch watch(child.pid(), child.mark(), limits);
  Prints prints(child.prints());
  FrameReader frames(limits.memory_bytes);  // no answer is larger than the child's memory
  bool is_open = true;                      // the child may close it
  for (;;) {
    if (should_stop && should_stop()) throw Interrupted();
    const std::optional<int> ended = child.Ended();
    // After the child's end all that is left is read; before, only what has arrived.
    for (int patience_ms = ended ? 0 : 100; is_open; patience_ms = 0) {
      pollfd ready[] = {{child.in(), POLLIN, 0}, {child.listener(), POLLIN, 0}, {prints.file(), POLLIN, 0}};
      if (poll(ready, 3, patience_ms) <= 0) break;
      if (ready[2].revents != 0) prints.Read();
      if ((ready[1].revents & POLLIN) != 0) AnswerPathCall(child.listener());
      if (ready[0].revents != 0) is_open = frames.ReadFrom(child.in());
      if (!ended || ready[0].revents == 0) break;
    }
    while (const std::optional<Frame> frame = frames.Next()) {
      const std::string& message = frame->bytes;
      if (frame->kind == kDone) return;
      if (frame->kind == kProblem) throw PluginError(Printable(message, 1000));
      if (frame->kind == kThrew)
        throw ContainedEnd("threw " + Printable(message, 1000) + Place(child.At()), child.At());
      if (frame->kind == kAsked) throw ContainedEnd(AskedCall(message) + Place(child.At()), child.At());
      if (frame->kind == kUnheld)
        throw NoChild("the kernel gives no seccomp filter for a control law: " + Printable(message, 1000));
      if (frame->kind == kSaid) hear(message);
    }
    // A law can write into the pipe, too.
    if (frames.is_spoilt())
      throw ContainedEnd("answered with what is no result" + Place(child.At()), child.At());
    if (ended) throw ContainedEnd(HowItEnded(*ended, limits) + Place(child.At()), child.At());
    if (!is_open) {
      watch.AwaitEnd();
      poll(nullptr, 0, 20);
    }
    if (watch.TookTooLong()) {
      char text[128];
      std::snprintf(text, sizeof text,
                    "did not return from a call within %g s of computing or %g s of waiting",
                    limits.call_cpu_s, limits.call_wait_s);
      throw ContainedEnd(text + Place(child.At()), child.At());
    }
  }
}

SandboxParts SandboxHere() {
  SandboxParts holds{false, false, false, false};
  try {
    RunContained(
        [](const Say& say) {
          say({static_cast<char>(sandbox.seccomp), static_cast<char>(sandbox.landlock),
               static_cast<char>(sandbox.paths && access("/proc/self/exe", F_OK) != 0),
               static_cast<char>(sandbox.namespaces)});
        },
        [&](const std::string& message) {
          holds = {message.at(0) == 1, message.at(1) == 1, message.at(2) == 1, message.at(3) == 1};
        });
  } catch (const NoChild&) {
    // None of them.
  }
  return holds;
}

void RefusePlugins(const std::string& why, std::set<std::string> but) {
  refusal = why;
  not_refused = std::move(but);
}
std::string PluginRefusal(const std::string& sha256) { return not_refused.contains(sha256) ? "" : refusal; }

PluginDescription DescribeContained(const PluginConfig& config) {
  // Shorter than the five seconds in which a coordinator that is told to end has to.
  ContainmentLimits limits;
  limits.call_wait_s = 3.0;
  std::vector<std::string> texts;
  RunContained(
      [&](const Say& say) {
        const PluginDescription description = PluginLaw(config).Describe();
        say(description.name);
        say(description.version);
        for (const std::string& name : description.parameters) say(name);
      },
      [&](const std::string& text) { texts.push_back(text); }, nullptr, limits);
  return DescriptionOf(texts);
}

PluginDescription DescriptionOf(const std::vector<std::string>& texts) {
  if (texts.size() < 2) throw PluginError("describes nothing");
  PluginDescription description{Printable(texts[0], 64), Printable(texts[1], 64), {}};
  for (std::size_t i = 2; i < texts.size(); ++i) {
    if (Printable(texts[i], 64) != texts[i])
      throw PluginError("has a parameter with the name '" + Printable(texts[i], 64) +
                        "', which is not up to 64 printable ASCII characters");
    description.parameters.push_back(texts[i]);
  }
  return description;
}

}  // namespace dispersa
