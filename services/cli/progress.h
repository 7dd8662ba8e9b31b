// How far a long command is, on stderr.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace dispersa {

/// Progress: on a terminal a bar that is drawn again, elsewhere a line every few seconds, nothing if quiet.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  /// Ends the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap to call: shows something only when it is due. `note` goes to the end of the line.
  void Show(std::uint64_t done, std::uint64_t total, const std::string& note = "");

 private:
  std::string what_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  bool begun_ = false;
  std::uint64_t first_done_ = 0;  ///< number done before this command
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point shown_;
};

/// "######....": 30 characters.
std::string ProgressBar(std::uint64_t done, std::uint64_t total);
/// "1h02m", "3m05s", "12s"
std::string DurationText(double seconds);

}  // namespace dispersa
