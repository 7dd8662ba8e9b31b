#include "core/containment/sandbox.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace dispersa {
namespace {

// System calls needed to load a shared object and to compute. Landlock restricts paths.
constexpr int kAllowedCalls[] = {
    // Memory.
    SCMP_SYS(brk), SCMP_SYS(mmap), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(mprotect), SCMP_SYS(madvise),
    // Files that are open. memfd_create keeps a law's bytes.
    SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(lseek), SCMP_SYS(close),
    SCMP_SYS(fstat), SCMP_SYS(getcwd), SCMP_SYS(memfd_create),
    // Time and waiting.
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(time), SCMP_SYS(times),
    SCMP_SYS(nanosleep), SCMP_SYS(clock_nanosleep), SCMP_SYS(sched_yield), SCMP_SYS(futex),
    // This process: who it is, its signals, its end.
    SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(getppid), SCMP_SYS(getuid), SCMP_SYS(geteuid),
    SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(uname), SCMP_SYS(sysinfo), SCMP_SYS(getrusage),
    SCMP_SYS(getcpu), SCMP_SYS(sched_getaffinity), SCMP_SYS(getrandom), SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack), SCMP_SYS(restart_syscall),
    SCMP_SYS(exit), SCMP_SYS(exit_group)};

// What a loader asks of paths: the process outside answers. The position of the path among the arguments.
constexpr struct {
  int call;
  unsigned path;
} kPathCalls[] = {{SCMP_SYS(open), 0},       {SCMP_SYS(openat), 1},     {SCMP_SYS(stat), 0},
                  {SCMP_SYS(lstat), 0},      {SCMP_SYS(access), 0},     {SCMP_SYS(faccessat), 1},
                  {SCMP_SYS(faccessat2), 1}, {SCMP_SYS(newfstatat), 1}, {SCMP_SYS(readlink), 0}};

// Only with such an argument.
struct AllowedWith {
  int call;
  scmp_arg_cmp argument;
};

scmp_arg_cmp Masked(unsigned argument, std::uint64_t mask, std::uint64_t value) {
  return {argument, SCMP_CMP_MASKED_EQ, mask, value};
}
scmp_arg_cmp Is(unsigned argument, std::uint64_t value) { return {argument, SCMP_CMP_EQ, value, 0}; }

// `of_paths`: what becomes of calls with a path. A file is opened for reading alone.
bool AllowCalls(scmp_filter_ctx filter, std::uint32_t of_paths) {
  for (const int call : kAllowedCalls)
    if (seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) != 0) return false;
  constexpr std::uint64_t kWrites = O_ACCMODE | O_CREAT | O_TRUNC;
  for (const auto& [call, path] : kPathCalls) {
    const bool opens = call == SCMP_SYS(open) || call == SCMP_SYS(openat);
    const scmp_arg_cmp reads = Masked(path + 1, kWrites, O_RDONLY);
    if (seccomp_rule_add_array(filter, of_paths, call, opens ? 1 : 0, &reads) != 0) return false;
  }
  const auto self = static_cast<std::uint64_t>(getpid());
  const AllowedWith with_arguments[] = {
      // The way of this process's answers, on which it sends its listener.
      {SCMP_SYS(sendmsg), Is(0, kAnswers)},
      {SCMP_SYS(fcntl), Is(1, F_GETFD)},
      {SCMP_SYS(fcntl), Is(1, F_SETFD)},
      {SCMP_SYS(fcntl), Is(1, F_GETFL)},
      // Whether it writes to a terminal, and no byte put into the terminal's input.
      {SCMP_SYS(ioctl), Is(1, TCGETS)},
      // abort() and raise(), and no signal to anyone else.
      {SCMP_SYS(tgkill), Is(0, self)},
      {SCMP_SYS(kill), Is(0, self)},
      {SCMP_SYS(prctl), Is(0, PR_GET_NAME)},
      {SCMP_SYS(prctl), Is(0, PR_SET_NAME)},
      // Limits are read and not set.
      {SCMP_SYS(prlimit64), Is(2, 0)},
  };
  return std::all_of(std::begin(with_arguments), std::end(with_arguments), [&](const AllowedWith& one) {
    return seccomp_rule_add(filter, SCMP_ACT_ALLOW, one.call, 1, one.argument) == 0;
  });
}

// SYS_SECCOMP of the kernel's headers, which clash with the C library's.
constexpr int kOfFilter = 1;

void (*call_refused)(int call) = nullptr;

void OnRefusedCall(int, siginfo_t* info, void*) {
  if (info->si_code == kOfFilter) call_refused(info->si_syscall);
}

// The listener of a filter that holds: -1 if the kernel has none. None: no filter.
std::optional<int> LoadFilter(std::uint32_t of_paths) {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_TRAP);
  if (filter == nullptr) return std::nullopt;
  // Rules as a tree, and no change of the processor's speculation: a flight costs what it did.
  seccomp_attr_set(filter, SCMP_FLTATR_CTL_OPTIMIZE, 2);
  seccomp_attr_set(filter, SCMP_FLTATR_CTL_SSB, 1);
  const bool holds = AllowCalls(filter, of_paths) && seccomp_load(filter) == 0;
  const int listener = holds && of_paths == SCMP_ACT_NOTIFY ? seccomp_notify_fd(filter) : -1;
  seccomp_release(filter);
  return holds ? std::optional(listener) : std::nullopt;
}

std::optional<int> FilterCalls(void (*refused)(int call), bool listens) {
  call_refused = refused;
  struct sigaction action {};
  action.sa_sigaction = OnRefusedCall;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  // A container may have a listener already, and there is one at most: then Landlock alone keeps files.
  if (listens)
    if (const std::optional<int> listener = LoadFilter(SCMP_ACT_NOTIFY)) return listener;
  return LoadFilter(SCMP_ACT_ALLOW);
}

// Debian 12's header ends before these.
struct LandlockRules {
  std::uint64_t handled_files, handled_network, scoped;
};
constexpr std::uint64_t kTruncate = 1u << 14, kDeviceControl = 1u << 15;
constexpr std::uint64_t kTcpBindAndConnect = 3, kAbstractSocketsAndSignals = 3;

// Folders in which the loader finds dependencies of a shared object.
constexpr const char* kReadable[] = {"/lib",       "/lib64",         "/usr/lib",
                                     "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache"};

// Landlock has no functions in the C library.
bool ShutFiles() {
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  LandlockRules rules{(LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1, 0, 0};
  std::size_t size = sizeof rules.handled_files;
  if (version >= 2) rules.handled_files |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rules.handled_files |= kTruncate;
  if (version >= 4) {
    rules.handled_network = kTcpBindAndConnect;
    size = sizeof rules.handled_files + sizeof rules.handled_network;
  }
  if (version >= 5) rules.handled_files |= kDeviceControl;
  if (version >= 6) {
    rules.scoped = kAbstractSocketsAndSignals;
    size = sizeof rules;
  }
  const int ruleset = static_cast<int>(syscall(SYS_landlock_create_ruleset, &rules, size, 0));
  if (ruleset < 0) return false;
  for (const char* path : kReadable) {
    landlock_path_beneath_attr beneath{LANDLOCK_ACCESS_FS_READ_FILE, open(path, O_PATH | O_CLOEXEC)};
    if (beneath.parent_fd < 0) continue;
    syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0);
    close(beneath.parent_fd);
  }
  const bool holds = syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
  close(ruleset);
  return holds;
}

}  // namespace

SandboxParts EnterSandbox(const SandboxParts& wanted, void (*refused)(int call), int* listener) {
  SandboxParts holds;
  *listener = -1;
  holds.namespaces = wanted.namespaces && unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0;
  // After a new user namespace, which clears it.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Both others ask for this.
  const bool is_meek = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
  holds.landlock = wanted.landlock && is_meek && ShutFiles();
  const std::optional<int> filter =
      wanted.seccomp && is_meek ? FilterCalls(refused, wanted.paths) : std::nullopt;
  holds.seccomp = filter.has_value();
  *listener = filter.value_or(-1);
  holds.paths = *listener >= 0;
  return holds;
}

namespace {

bool IsForLoader(const std::string& path) {
  constexpr std::string_view kOwnFiles = "/proc/self/fd/";
  if (path.find("/../") != std::string::npos || path.ends_with("/..")) return false;
  if (path.starts_with(kOwnFiles)) {
    return std::all_of(path.begin() + kOwnFiles.size(), path.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
  }
  return path.empty() ||
         std::any_of(std::begin(kReadable), std::end(kReadable), [&](const std::string& known) {
           return path == known || path.starts_with(known + "/");
         });
}

// A text of another process: what is longer than any path, or not there, is none. Nothing if the system keeps
// that process's memory from this one, so that Landlock alone keeps files.
std::optional<std::string> TextOf(pid_t process, std::uint64_t address) {
  std::string text;
  char part[256];
  while (text.size() < PATH_MAX) {
    // To the end of a page at most: the next one may not be there.
    const std::size_t size = std::min<std::size_t>(sizeof part, 4096 - address % 4096);
    iovec here{part, size}, there{reinterpret_cast<void*>(address), size};
    if (process_vm_readv(process, &here, 1, &there, 1, 0) != static_cast<ssize_t>(size)) {
      if (errno == EPERM || errno == ENOSYS) return std::nullopt;
      break;
    }
    const std::size_t length = strnlen(part, size);
    text.append(part, length);
    if (length < size) return text;
    address += size;
  }
  return "?";
}

}  // namespace

void AnswerPathCall(int listener) {
  seccomp_notif* asked = nullptr;
  seccomp_notif_resp* answer = nullptr;
  if (seccomp_notify_alloc(&asked, &answer) != 0) return;
  if (seccomp_notify_receive(listener, asked) == 0) {
    const auto call = std::find_if(std::begin(kPathCalls), std::end(kPathCalls),
                                   [&](const auto& each) { return each.call == asked->data.nr; });
    const bool is_known = call != std::end(kPathCalls);
    // The process has one thread, so the path stays what it is.
    const auto path = is_known ? TextOf(static_cast<pid_t>(asked->pid), asked->data.args[call->path]) : "?";
    const bool may = !path || IsForLoader(*path);
    *answer = {};
    answer->id = asked->id;
    answer->error = may ? 0 : -ENOENT;
    answer->flags = may ? SECCOMP_USER_NOTIF_FLAG_CONTINUE : 0;
    seccomp_notify_respond(listener, answer);
  }
  seccomp_notify_free(asked, answer);
}

std::string SystemCallName(int call) {
  char* const found = seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, call);
  const std::string name = found == nullptr ? std::to_string(call) : found;
  std::free(found);
  return name;
}

std::string WhyNoSandbox() { return ""; }

}  // namespace dispersa
