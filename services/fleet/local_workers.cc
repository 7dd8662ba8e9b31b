#include "services/fleet/local_workers.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "services/program/utc.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

constexpr int kExecFailed = 127;
constexpr double kLongestDelay_s = 2.0;

// The read end of a pipe that holds this text. The text fits into the buffer, so writing it does not wait for
// a reader.
int PipeWith(const std::string& text) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw NetworkError(std::string("no pipe can be made: ") + std::strerror(errno));
  const bool is_whole = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(ends[1]);
  if (is_whole) return ends[0];
  close(ends[0]);
  throw NetworkError("no pipe can be filled");
}

// Between fork and exec of a process with threads: only what is safe in a signal handler.
[[noreturn]] void BecomeWorker(const char* program, char* const* arguments, pid_t parent, int pass) {
  // The kernel kills the worker when its parent ends. If the parent has ended before this call, the signal
  // would not come.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kExecFailed);
  if (pass >= 0) fcntl(pass, F_SETFD, 0);  // this one stays open
  execv(program, arguments);
  _exit(kExecFailed);
}

}  // namespace

WorkerEnd ClassifyExit(int status, std::string* how) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    *how = "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    const bool from_outside = signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
    return from_outside ? WorkerEnd::kKilled : WorkerEnd::kCrashed;
  }
  const int code = WEXITSTATUS(status);
  *how = code == kExecFailed ? "exit code 127 (the program cannot be started)"
                             : "exit code " + std::to_string(code);
  return code == 0 ? WorkerEnd::kLeft : WorkerEnd::kCrashed;
}

LocalWorkers::LocalWorkers(std::filesystem::path program, std::vector<std::string> arguments, int count,
                           std::string pass)
    : program_(std::move(program)),
      arguments_(std::move(arguments)),
      pass_(std::move(pass)),
      slots_(static_cast<std::size_t>(count)) {}

LocalWorkers::~LocalWorkers() {
  SignalAll(SIGKILL);
  WaitAll(1.0);
}

LocalWorkers::Changes LocalWorkers::Poll(double now_s, std::uint64_t progress) {
  Changes changes;
  if (history_.empty()) joined_s_ = now_s;
  if (progress != progress_) {
    progress_ = progress;
    fruitless_ends_ = 0;
    start_due_s_ = now_s;
  }
  changes.ended = Reap();
  for (std::size_t i = 0; i < changes.ended.size(); ++i) {
    if (++fruitless_ends_ > 1) {
      start_due_s_ = now_s + std::min(0.05 * std::exp2(fruitless_ends_ - 2), kLongestDelay_s);
    }
  }
  if (now_s < start_due_s_) return changes;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (slots_[slot]) continue;
    Start(slot);
    changes.started.push_back(history_.back());
  }
  return changes;
}

void LocalWorkers::NoteJoined(std::size_t joined, double now_s) {
  if (joined > 0) joined_s_ = now_s;
}

void LocalWorkers::Kill(const std::string& uuid) {
  for (const auto& slot : slots_) {
    if (slot && history_[*slot].uuid == uuid) kill(history_[*slot].pid, SIGKILL);
  }
}

void LocalWorkers::End(double patience_s) {
  // Not SIGTERM: workers would finish their cases, and no one needs them.
  if (WaitAll(patience_s)) return;
  SignalAll(SIGKILL);
  WaitAll(1.0);
}

int LocalWorkers::alive() const {
  return static_cast<int>(std::count_if(slots_.begin(), slots_.end(), [](const auto& slot) { return slot; }));
}

void LocalWorkers::Start(std::size_t slot) {
  WorkerProcess worker;
  worker.uuid = MakeUuid();
  std::vector<std::string> words = {program_.string()};
  words.insert(words.end(), arguments_.begin(), arguments_.end());
  words.insert(words.end(), {"--uuid", worker.uuid});
  const int pass = pass_.empty() ? -1 : PipeWith(pass_);
  if (pass >= 0) words.insert(words.end(), {"--run-pass", std::to_string(pass)});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const pid_t parent = getpid();
  worker.started_utc = UtcNow();
  worker.pid = fork();
  if (worker.pid == 0) BecomeWorker(pointers.front(), pointers.data(), parent, pass);
  const int error = errno;
  if (pass >= 0) close(pass);
  if (worker.pid < 0) throw NetworkError(std::string("no process can be started: ") + std::strerror(error));
  slots_[slot] = history_.size();
  history_.push_back(std::move(worker));
}

std::vector<WorkerProcess> LocalWorkers::Reap() {
  std::vector<WorkerProcess> ended;
  for (auto& slot : slots_) {
    if (!slot) continue;
    WorkerProcess& worker = history_[*slot];
    int status = 0;
    if (waitpid(worker.pid, &status, WNOHANG) != worker.pid) continue;
    worker.end = ClassifyExit(status, &worker.how);
    worker.ended_utc = UtcNow();
    ended.push_back(worker);
    slot.reset();
  }
  return ended;
}

bool LocalWorkers::WaitAll(double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    Reap();
    if (alive() == 0) return true;
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

void LocalWorkers::SignalAll(int signal) {
  for (const auto& slot : slots_) {
    if (slot) kill(history_[*slot].pid, signal);
  }
}

}  // namespace dispersa
