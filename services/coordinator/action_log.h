// DATA/actions.jsonl: who did what to campaigns and workers of a coordinator, and when.
#pragma once

#include <deque>
#include <filesystem>
#include <string>

namespace dispersa {

/// Empty members are null in the line, or not in it.
struct Action {
  std::string what = {};      ///< "launch", "cancel", "delete", "give", "repair", "expel", "readmit"
  std::string by = {};        ///< name of keys, or local user; empty: the coordinator itself
  std::string client = {};    ///< the process that asked
  std::string campaign = {};  ///< id
  std::string name = {};      ///< of the campaign
  std::string to = {};        ///< the new owner
  std::string worker = {};    ///< or keys, or keys on a host
  std::string reason = {};
};

/// Lines are only added, each one JSON object, for nobody else to read (0600). A line follows its action. If
/// the disk does not take it, it waits here, and nothing else may be done before it is written.
class ActionLog {
 public:
  /// Throws ResultError if the file cannot be made.
  explicit ActionLog(std::filesystem::path file);

  void Note(const Action& action);
  /// Writes what waits, as far as the disk takes it.
  void Retry();
  /// Throws ResultError if a line waits that still cannot be written.
  void RequireWritten();
  /// Why lines wait; empty: none does.
  const std::string& problem() const { return problem_; }

 private:
  void WriteAll();

  std::filesystem::path file_;
  std::deque<std::string> waiting_;
  std::string problem_;
};

}  // namespace dispersa
