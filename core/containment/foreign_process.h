// Foreign code runs in processes of the program dispersa-foreign. This process starts one by exec and speaks
// with it through a socket. So nothing that this process has read or made, such as keys and other campaigns,
// was ever in that one's memory. It forks a contained child (contained.h) for each order.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "core/containment/contained.h"

namespace dispersa {

/// A process of dispersa-foreign, which does not outlive this object. Its environment has what chooses the
/// engine, and it has no file of this process but the standard error.
class ForeignProcess {
 public:
  /// Throws PluginError if there is no such program, and NoChild.
  ForeignProcess();
  ~ForeignProcess();
  ForeignProcess(const ForeignProcess&) = delete;
  ForeignProcess& operator=(const ForeignProcess&) = delete;

  /// Sends an order and receives its answer, as RunContained does, with its exceptions. After any but
  /// PluginError and ContainedEnd the process is of no further use, and is_usable() says so.
  void Ask(const std::string& order, const Say& hear, const StopCheck& should_stop = nullptr);
  bool is_usable() const { return is_usable_; }
  pid_t pid() const { return pid_; }

 private:
  [[noreturn]] void Fail(const std::string& why);

  pid_t pid_ = -1;
  int socket_ = -1;
  bool is_usable_ = true;
};

/// From now on every Ask() of this process, also one under way, throws Interrupted: this process ends,
/// whatever a law is doing.
void EndForeignProcesses();

/// What foreign code prints goes to this descriptor in place of the standard error. Call it before any thread
/// starts.
void SendForeignOutputTo(int file);

/// A plug-in's description of itself, asked in such a process. Throws PluginError, ContainedEnd, NoChild.
PluginDescription DescribePlugin(const PluginConfig& config);

/// Answers an order. `should_stop` says when nobody waits for the answer any more.
using AnswerOrder =
    std::function<void(const std::string& order, const Say& say, const StopCheck& should_stop)>;

/// The orders of dispersa-foreign begin with one of these. The first is about a library, its bytes behind it.
inline constexpr char kDescribeOrder = 'd', kCampaignOrder = 'c', kFlightOrder = 'f';

/// The life of dispersa-foreign: answers orders until its parent has ended. In such a process foreign code is
/// forked from it, so DescribePlugin() is DescribeContained().
void ServeOrders(const AnswerOrder& answer);

}  // namespace dispersa
