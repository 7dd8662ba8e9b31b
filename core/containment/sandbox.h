// Limits on a control law's process: system calls, files, network.
#pragma once

#include <string>

namespace dispersa {

/// The parts of a sandbox: those that are asked for, or those that hold.
struct SandboxParts {
  bool seccomp = true;     ///< allow only the system calls of a computation (any other one ends the process)
  bool landlock = true;    ///< no file is opened but shared objects in the system's folders
  bool paths = true;       ///< with seccomp: no path but a loader's exists, whatever the call that asks
  bool namespaces = true;  ///< a user without rights, and a network without interfaces
};

/// The descriptor on which a process that is shut in sends its answers.
inline constexpr int kAnswers = 3;

/// Shuts this process in for good, and ends it with its parent. The process must have one thread. The answer
/// lacks the parts that the kernel does not have. A system call that is not allowed has no effect: a signal
/// handler calls `refused` with its number. A call with a path waits until another process, with `listener`,
/// answers it (AnswerPathCall); -1: the kernel has no listener, and Landlock alone keeps files.
SandboxParts EnterSandbox(const SandboxParts& wanted, void (*refused)(int call), int* listener);

/// Answers one call, when the listener is ready to be read: a path outside the folders of the system's shared
/// objects does not exist.
void AnswerPathCall(int listener);

/// Why this build has no sandbox, of a control law; empty: it has one.
std::string WhyNoSandbox();

/// The name of a system call, as in the manual.
std::string SystemCallName(int call);

}  // namespace dispersa
