// How often a daemon says the same: a line that comes by thousands must not fill a disk or hide the others.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

/// Lines are of one kind if they have the same kind's name. Of each kind so many are written in a minute. The
/// others are counted, and the count is written when the minute is over. Not thread-safe.
class LogLimits {
 public:
  static constexpr std::uint64_t kMost = 60;
  static constexpr double kWindow_s = 60.0;

  /// Whether this line is to be written. A line of the kind "" always is.
  bool Take(std::string_view kind, std::string_view text, double now_s);
  /// "… and 312 more like it in the last minute: TEXT", for each kind whose minute is over, with its last
  /// text.
  std::vector<std::string> TakeCounts(double now_s);

 private:
  struct Kind {
    double since_s = 0.0;
    std::uint64_t written = 0;
    std::uint64_t unsaid = 0;
    std::string last;  ///< unsaid
  };
  std::map<std::string, Kind, std::less<>> kinds_;  ///< those with a line in their minute
};

}  // namespace dispersa
