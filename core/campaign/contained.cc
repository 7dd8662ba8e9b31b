#include "core/campaign/contained.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

namespace dispersa {
namespace {

bool contained = false;
std::string refusal;

// Kinds of frames in the pipe: a byte, the size as 8 bytes, the bytes.
constexpr char kSaid = 's', kProblem = 'p', kDone = 'd';

void WriteAll(int file, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t part = write(file, at, size);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) _exit(1);  // nobody listens any more
    at += part;
    size -= static_cast<std::size_t>(part);
  }
}

void WriteFrame(int file, char kind, const std::string& bytes) {
  const std::uint64_t size = bytes.size();
  WriteAll(file, &kind, 1);
  WriteAll(file, &size, sizeof size);
  WriteAll(file, bytes.data(), bytes.size());
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

[[noreturn]] void BeChild(int out, pid_t parent, volatile PluginMark* mark, const ContainmentLimits& limits,
                          const std::function<void(const Say& say)>& work) {
  contained = true;
  MarkPluginCallsIn(mark);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  // An interrupt reaches the whole group; the parent decides what it means. Other signals mean what they do.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE}) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  // No file of this process is the plug-in's, and what it prints is no result.
  if (out != 3) {
    dup2(out, 3);
    out = 3;
  }
  fcntl(3, F_SETFD, FD_CLOEXEC);
  close_range(4, ~0u, 0);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_AS, VirtualBytes() + limits.memory_bytes);
  try {
    work([out](const std::string& message) { WriteFrame(out, kSaid, message); });
    WriteFrame(out, kDone, "");
  } catch (const std::exception& error) {
    WriteFrame(out, kProblem, error.what());
  } catch (...) {
    WriteFrame(out, kProblem, "threw what is no std::exception");
  }
  _exit(0);  // nothing of the parent's is destroyed here
}

std::string HowItEnded(int status, const ContainmentLimits& limits) {
  if (!WIFSIGNALED(status)) return "ended the process with exit code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  const char* const name = sigabbrev_np(signal);
  return "ended by signal " + std::to_string(signal) + (name ? " (SIG" + std::string(name) + ")" : "") +
         ", in a process that may allocate " + std::to_string(limits.memory_bytes >> 20) + " MiB";
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
    if (calls != calls_ || calls % 2 == 0) {
      calls_ = calls;
      since_ = now;
      since_cpu_s_ = cpu_s;
      return false;
    }
    return cpu_s - since_cpu_s_ > limits_.call_cpu_s ||
           std::chrono::duration<double>(now - since_).count() > limits_.call_wait_s;
  }

 private:
  const volatile PluginMark& mark_;
  const ContainmentLimits limits_;
  clockid_t clock_ = CLOCK_MONOTONIC;
  std::uint64_t calls_ = 0;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  double since_cpu_s_ = 0.0;
};

// A child, which does not outlive this object.
class Child {
 public:
  Child(const std::function<void(const Say& say)>& work, const ContainmentLimits& limits) {
    void* const shared =
        mmap(nullptr, sizeof(PluginMark), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int ends[2];
    if (shared == MAP_FAILED || pipe2(ends, O_CLOEXEC) != 0)
      throw std::runtime_error(std::string("no process for a plug-in can be prepared: ") +
                               std::strerror(errno));
    mark_ = new (shared) PluginMark();
    const pid_t parent = getpid();
    std::fflush(nullptr);
    pid_ = fork();
    if (pid_ == 0) BeChild(ends[1], parent, mark_, limits, work);
    const int error = errno;
    close(ends[1]);
    in_ = ends[0];
    if (pid_ < 0)
      throw std::runtime_error(std::string("no process for a plug-in can be started: ") +
                               std::strerror(error));
  }
  ~Child() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      Wait();
    }
    close(in_);
    munmap(const_cast<PluginMark*>(mark_), sizeof(PluginMark));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  int in() const { return in_; }
  const volatile PluginMark& mark() const { return *mark_; }
  PluginMark At() const { return {mark_->case_index, mark_->calls, mark_->time_s, mark_->stage}; }
  int Wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
    pid_ = -1;
    return status;
  }

 private:
  volatile PluginMark* mark_ = nullptr;
  pid_t pid_ = -1;
  int in_ = -1;
};

}  // namespace

void RunContained(const std::function<void(const Say& say)>& work, const Say& hear,
                  const ContainmentLimits& limits) {
  Child child(work, limits);
  CallWatch watch(child.pid(), child.mark(), limits);
  std::string bytes;
  bool is_done = false;
  for (;;) {
    pollfd ready{child.in(), POLLIN, 0};
    const int count = poll(&ready, 1, 100);
    if (count < 0 && errno != EINTR) throw std::runtime_error(std::strerror(errno));
    if (count <= 0) {
      if (watch.TookTooLong()) {
        char text[128];
        std::snprintf(text, sizeof text,
                      "did not return from a call within %g s of computing or %g s of waiting",
                      limits.call_cpu_s, limits.call_wait_s);
        throw ContainedEnd(text + Place(child.At()), child.At());
      }
      continue;
    }
    char part[65536];
    const ssize_t size = read(child.in(), part, sizeof part);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    bytes.append(part, static_cast<std::size_t>(size));
    std::size_t at = 0;
    for (;;) {
      std::uint64_t length = 0;
      if (bytes.size() - at < 1 + sizeof length) break;
      std::memcpy(&length, bytes.data() + at + 1, sizeof length);
      if (bytes.size() - at - 1 - sizeof length < length) break;
      const char kind = bytes[at];
      const std::string message = bytes.substr(at + 1 + sizeof length, length);
      at += 1 + sizeof length + length;
      if (kind == kProblem) throw PluginError(message);
      is_done |= kind == kDone;
      if (kind == kSaid) hear(message);
    }
    bytes.erase(0, at);
  }
  const int status = child.Wait();
  if (!is_done) throw ContainedEnd(HowItEnded(status, limits) + Place(child.At()), child.At());
}

bool IsContained() { return contained; }

void RefusePlugins(const std::string& why) { refusal = why; }
const std::string& PluginRefusal() { return refusal; }

PluginDescription DescribeContained(const PluginConfig& config) {
  std::vector<std::string> texts;
  RunContained(
      [&](const Say& say) {
        const PluginDescription description = PluginLaw(config).Describe();
        say(description.name);
        say(description.version);
        for (const std::string& name : description.parameters) say(name);
      },
      [&](const std::string& text) { texts.push_back(text); });
  if (texts.size() < 2) throw PluginError("describes nothing");
  return {texts[0], texts[1], {texts.begin() + 2, texts.end()}};
}

}  // namespace dispersa
