#include "core/containment/contained.h"
#include "tests/test.h"

#include <fcntl.h>
#include <linux/io_uring.h>
#include <sys/ioctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace dispersa::containment_sandbox_test {
namespace {

ContainmentLimits With(const SandboxParts& parts) {
  ContainmentLimits limits;
  limits.sandbox = parts;
  return limits;
}
const ContainmentLimits kFloor = With({.seccomp = true, .landlock = false, .namespaces = false});

// The message of the child, or how it ended.
std::string Outcome(const std::function<std::string()>& work, const ContainmentLimits& limits) {
  std::string heard;
  try {
    RunContained([&](const Say& say) { say(work()); }, [&](const std::string& said) { heard += said; },
                 nullptr, limits);
  } catch (const ContainedEnd& end) {
    return end.what();
  }
  return heard;
}

// A call that a child makes, which says 1 if it came through.
std::string OutcomeOf(const std::function<long()>& call, const ContainmentLimits& limits = kFloor) {
  return Outcome([&] { return call() >= 0 ? std::string("it worked") : "refused: " + std::to_string(errno); },
                 limits);
}

TEST(Sandbox, SeccompAloneRefusesWhatIsNoComputation) {
  const pid_t parent = getpid();
  const std::vector<std::pair<std::string, std::function<long()>>> calls = {
      {"socket", [] { return socket(AF_INET, SOCK_STREAM, 0); }},
      {"socketpair",
       [] {
         int ends[2];
         return socketpair(AF_UNIX, SOCK_STREAM, 0, ends);
       }},
      {"clone", [] { return fork(); }},
      {"vfork", [] { return syscall(SYS_vfork); }},
      {"clone3", [] { return syscall(SYS_clone3, nullptr, 0); }},
      {"execve", [] { return execl("/bin/true", "true", nullptr); }},
      {"execveat", [] { return syscall(SYS_execveat, 0, "/bin/true", nullptr, nullptr, 0); }},
      {"ptrace", [=] { return ptrace(PTRACE_ATTACH, parent, nullptr, nullptr); }},
      {"process_vm_writev",
       [=] { return syscall(SYS_process_vm_writev, parent, nullptr, 0, nullptr, 0, 0); }},
      {"pidfd_open", [=] { return syscall(SYS_pidfd_open, parent, 0); }},
      {"kill", [=] { return kill(parent, 0); }},
      {"tgkill", [=] { return syscall(SYS_tgkill, parent, parent, 0); }},
      {"openat", [] { return open("/tmp/dispersa-sandbox-test", O_WRONLY | O_CREAT, 0600); }},
      {"openat", [] { return open("/dev/null", O_RDWR); }},
      {"unlink", [] { return unlink("/tmp/dispersa-sandbox-test"); }},
      {"ioctl", [] { return ioctl(2, TIOCSTI, "x"); }},
      {"io_uring_setup",
       [] {
         io_uring_params parameters{};
         return syscall(SYS_io_uring_setup, 1, &parameters);
       }},
      {"unshare", [] { return syscall(SYS_unshare, 0); }},
      {"mount", [] { return syscall(SYS_mount, "a", "b", "c", 0, nullptr); }},
      {"bpf", [] { return syscall(SYS_bpf, 0, nullptr, 0); }},
      {"setpriority", [] { return setpriority(PRIO_PROCESS, 0, 0); }},
      {"prlimit64",
       [] {
         const rlimit none{0, 0};
         return setrlimit(RLIMIT_CORE, &none);
       }},
  };
  for (const auto& [name, call] : calls) {
    const std::string refused = "was refused the system call '" + name + "'";
    if (name == "clone")  // glibc of Debian 13 forks with all signals blocked: then nothing names the call
      EXPECT_THAT(OutcomeOf(call), testing::AnyOf(refused,
                                                  "ended by signal 31 (SIGSYS), after a system call "
                                                  "that it may not make"));
    else
      EXPECT_EQ(OutcomeOf(call), refused);
  }
}

TEST(Sandbox, WhoCatchesTheSignalHasGainedNothing) {
  // The number of the call that was not made is no file.
  EXPECT_EQ(Outcome(
                [] {
                  std::signal(SIGSYS, [](int) {});
                  socket(AF_INET, SOCK_STREAM, 0);
                  char name[64];
                  return readlink("/proc/self/fd/4", name, sizeof name) >= 0 ? "a file" : "no file";
                },
                kFloor),
            "no file");
  EXPECT_EQ(Outcome(
                [] {
                  std::signal(SIGSYS, SIG_IGN);
                  return std::to_string(socket(AF_INET, SOCK_STREAM, 0));
                },
                kFloor),
            "ended by signal 31 (SIGSYS), after a system call that it may not make");
}

TEST(Sandbox, WhatComputesGoesOn) {
  EXPECT_EQ(Outcome(
                [] {
                  std::vector<double> numbers(10'000'000, 1.0);
                  timespec now{}, moment{0, 1000};
                  clock_gettime(CLOCK_MONOTONIC, &now);
                  if (nanosleep(&moment, nullptr) != 0) return std::string("does not sleep");
                  rlimit limit{};
                  getrlimit(RLIMIT_AS, &limit);
                  return std::string(isatty(2) == 1 || numbers.back() == 1.0 ? "computed" : "");
                },
                {}),
            "computed");
  EXPECT_EQ(Outcome([]() -> std::string { std::abort(); }, {}),
            "ended by signal 6 (SIGABRT), in a process that may allocate 1024 MiB");
}

TEST(Sandbox, LandlockKeepsTheUsersFilesAndGivesTheSystemsObjects) {
  // A kernel without Landlock refuses nothing, and the sandbox says so.
  const std::string outcome = SandboxHere().landlock ? "refused: 13" : "it worked";
  const ContainmentLimits files =
      With({.seccomp = true, .landlock = true, .paths = false, .namespaces = false});
  const ContainmentLimits neither =
      With({.seccomp = true, .landlock = false, .paths = false, .namespaces = false});
  const std::string own = ::testing::TempDir() + "users_file";
  std::ofstream(own) << "a secret\n";
  const auto read = [](const std::string& path) { return [path] { return open(path.c_str(), O_RDONLY); }; };
  EXPECT_EQ(OutcomeOf(read(own), neither), "it worked");
  EXPECT_EQ(OutcomeOf(read(own), files), outcome);
  EXPECT_EQ(OutcomeOf(read("/etc/passwd"), files), outcome);
  EXPECT_EQ(OutcomeOf(read("/proc/self/environ"), files), outcome);
  EXPECT_EQ(OutcomeOf(read("/etc/ld.so.cache"), files), "it worked");
  EXPECT_EQ(OutcomeOf(read("/lib/x86_64-linux-gnu/libm.so.6"), files), "it worked");
}

TEST(Sandbox, WhatIsPrintedIsLinesOfPrintableText) {
  const auto shown = [](const std::function<void()>& print) {
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(Outcome([&] { return print(), std::string("done"); }, {}), "done");
    return ::testing::internal::GetCapturedStderr();
  };
  const auto print = [](const std::string& text, int file = 2) {
    if (write(file, text.data(), text.size()) < 0) abort();
  };
  EXPECT_EQ(shown([&] { print("one\ntwo", 1); }), "one\ntwo\n");
  EXPECT_EQ(shown([&] { print("\x1b[2J\r\xff\n\n"); }), "\\x1b[2J\\x0d\\xff\n\n");
  EXPECT_EQ(shown([&] { print(std::string(5000, 'a')); }), std::string(1000, 'a') + "...\n");
  const std::string many = shown([&] {
    for (int i = 0; i < 5000; ++i) print("a line of fifty characters, which is said too often\n");
  });
  EXPECT_LT(many.size(), 70'000u);
  EXPECT_EQ(many.substr(many.rfind('\n', many.size() - 2) + 1),
            "the control law prints more, which is not shown\n");
}

TEST(Sandbox, NoCallTellsWhichFilesExist) {
  ASSERT_TRUE(SandboxHere().paths) << "this kernel gives no listener: a law can tell which files exist here";
  using Ask = std::function<long(const char* path)>;
  struct stat out {};
  char text[64];
  const std::vector<std::pair<const char*, Ask>> calls = {
      {"access", [](const char* path) { return syscall(SYS_access, path, F_OK); }},
      {"faccessat", [](const char* path) { return syscall(SYS_faccessat, AT_FDCWD, path, F_OK); }},
      {"faccessat2", [](const char* path) { return syscall(SYS_faccessat2, AT_FDCWD, path, F_OK, 0); }},
      {"stat", [&](const char* path) { return syscall(SYS_stat, path, &out); }},
      {"lstat", [&](const char* path) { return syscall(SYS_lstat, path, &out); }},
      {"newfstatat",
       [&](const char* path) { return syscall(SYS_newfstatat, AT_FDCWD, path, &out, AT_EMPTY_PATH); }},
      {"open", [](const char* path) { return syscall(SYS_open, path, O_RDONLY); }},
      {"openat", [](const char* path) { return syscall(SYS_openat, AT_FDCWD, path, O_PATH); }},
      {"readlink", [&](const char* path) { return syscall(SYS_readlink, path, text, sizeof text); }}};
  for (const auto& [name, ask] : calls) {
    for (const char* path : {"/etc/passwd", "/nowhere", "/proc/1/exe", "/proc/self/fd/../environ",
                             "/usr/lib/../../etc/passwd", "."})
      EXPECT_EQ(OutcomeOf([&] { return ask(path); }), "refused: 2") << name << " " << path;
    // As a loader asks. A file is no link.
    EXPECT_EQ(OutcomeOf([&] { return ask("/etc/ld.so.cache"); }),
              name == std::string("readlink") ? "refused: 22" : "it worked")
        << name;
  }
  // Across the end of a page, and where nothing is.
  EXPECT_EQ(OutcomeOf([] { return syscall(SYS_access, std::string(5000, '/').c_str(), F_OK); }),
            "refused: 2");
  EXPECT_EQ(OutcomeOf([] { return syscall(SYS_access, nullptr, F_OK); }), "refused: 2");
  // Others may look into a library's folder, and not list it.
  EXPECT_EQ(OutcomeOf([] { return syscall(SYS_getdents64, 0, nullptr, 0); }),
            "was refused the system call 'getdents64'");
}

// Seen from outside while the child lives.
std::string NamespaceOf(const std::string& kind, const ContainmentLimits& limits) {
  std::string name = "?";
  RunContained(
      [](const Say& say) {
        say(std::to_string(getpid()));
        const timespec moment{0, 200'000'000};
        nanosleep(&moment, nullptr);
      },
      [&](const std::string& pid) {
        name = std::filesystem::read_symlink("/proc/" + pid + "/ns/" + kind).string();
      },
      nullptr, limits);
  return name;
}

TEST(Sandbox, NamespacesAreOfItsOwn) {
  for (const std::string kind : {"net", "user"}) {
    const std::string here = std::filesystem::read_symlink("/proc/self/ns/" + kind).string();
    EXPECT_EQ(NamespaceOf(kind, kFloor), here);
    const std::string inside =
        NamespaceOf(kind, With({.seccomp = true, .landlock = false, .namespaces = true}));
    EXPECT_EQ(inside != here, SandboxHere().namespaces) << inside;  // else the kernel gives none
  }
}

TEST(Sandbox, TheChildsInputIsEmptyAndItsPipeIsNoPlaceForAnythingElse) {
  // The user types something.
  int typed[2];
  ASSERT_EQ(pipe(typed), 0);
  ASSERT_EQ(write(typed[1], "secret", 6), 6);
  const int own = dup(STDIN_FILENO);
  dup2(typed[0], STDIN_FILENO);
  EXPECT_EQ(Outcome(
                [] {
                  char byte;
                  return std::to_string(read(0, &byte, 1));
                },
                {}),
            "0");
  dup2(own, STDIN_FILENO);
  for (const int file : {own, typed[0], typed[1]}) close(file);
  EXPECT_EQ(OutcomeOf([] { return write(3, "s\xff\xff\xff\xff\xff\xff\xff\x7f", 9); }, {}),
            "answered with what is no result");
  EXPECT_EQ(OutcomeOf([] { return write(3, "?\0\0\0\0\0\0\0\0", 9); }, {}),
            "answered with what is no result");
}

TEST(Sandbox, WithoutTheFloorNothingRuns) {
  const ContainmentLimits none = With({.seccomp = false, .landlock = false, .namespaces = false});
  std::string text;
  try {
    RunContained([](const Say& say) { say("ran"); }, [&](const std::string& said) { text = said; }, nullptr,
                 none);
  } catch (const NoChild& problem) {
    text = problem.what();
  }
  EXPECT_EQ(text.substr(0, text.find(':')), "the kernel gives no seccomp filter for a control law");
}

}  // namespace
}  // namespace dispersa::containment_sandbox_test
