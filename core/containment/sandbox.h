// What holds a control law's process back: system calls, files, network.
#pragma once

#include <string>

namespace dispersa {

/// The parts of a sandbox: those that are asked for, or those that hold.
struct SandboxParts {
  bool seccomp = true;     ///< only the system calls of a computation; any other one ends the process
  bool landlock = true;    ///< no file is opened but shared objects in the system's folders
  bool namespaces = true;  ///< a user without rights, and a network without interfaces
};

/// Shuts this process in, for good, and ends it with its parent. It must have one thread. A part that the
/// kernel does not give is missing from the answer. A system call that is not allowed has no effect;
/// `refused` is called with its number, in a signal handler.
SandboxParts EnterSandbox(const SandboxParts& wanted, void (*refused)(int call));

/// As the manual names it.
std::string SystemCallName(int call);

}  // namespace dispersa
