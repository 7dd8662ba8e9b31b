// Runs work that may crash, hang, end the process or allocate without limit, in a child process.
//
// The child is forked without a new program. It has all that this process has in memory, so foreign code is
// run only by dispersa-foreign (foreign_process.h). It has no files of this process but the streams for
// output. It runs on one thread, and must take no lock that another thread may hold here. It is shut in
// (sandbox.h): it computes, and reaches no file, network or process.
#pragma once

#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/containment/interrupted.h"
#include "core/containment/sandbox.h"
#include "core/control/plugin.h"

namespace dispersa {

/// A child that did not end well, in words for the user.
class ContainedEnd : public std::runtime_error {
 public:
  ContainedEnd(const std::string& text, const PluginMark& at) : std::runtime_error(text), at_(at) {}

  /// The call into a plug-in that was under way, or the last one.
  const PluginMark& at() const { return at_; }

 private:
  PluginMark at_;
};

struct ContainmentLimits {
  double call_cpu_s = 2.0;   ///< a call of more computing time counts as one that does not return,
  double call_wait_s = 5.0;  ///< or of more time while this process was awake
  std::size_t memory_bytes = std::size_t{1} << 30;  ///< beyond the memory of this process
  SandboxParts sandbox{};  ///< seccomp is needed, the others hold where the kernel gives them
};

using Say = std::function<void(const std::string& message)>;

/// The system has no memory, file, process or sandbox for a child now. This is no fault of the work.
class NoChild : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a child. Its messages are received here, in order, until it is done or the child has ended.
/// Throws PluginError with its text if `work` throws one. Throws ContainedEnd if it throws another error or
/// the child ends otherwise. Also throws NoChild, Interrupted, and any exception of `hear`.
void RunContained(const std::function<void(const Say& say)>& work, const Say& hear,
                  const StopCheck& should_stop = nullptr, const ContainmentLimits& limits = {});

/// A plug-in's description of itself, asked in a child. Throws PluginError, ContainedEnd.
PluginDescription DescribeContained(const PluginConfig& config);
/// What a plug-in says of itself (name, version, parameters), bounded and in printable ASCII. Throws
/// PluginError.
PluginDescription DescriptionOf(const std::vector<std::string>& texts);

/// Which parts of the sandbox hold for children of this process.
SandboxParts SandboxHere();

/// After this call the process loads no plug-ins, for the reason `why`, except those with a SHA-256 in `but`.
/// Call it before any thread starts.
void RefusePlugins(const std::string& why, std::set<std::string> but = {});
/// The reason why this library is not loaded. Empty if it may be loaded.
std::string PluginRefusal(const std::string& sha256);

}  // namespace dispersa
